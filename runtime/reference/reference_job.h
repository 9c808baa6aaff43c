// What prt-render --reference does: the same picture as runtime/render_job.h's, path traced.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/checkpoint.h"
#include "core/report.h"
#include "runtime/render_job.h"

namespace prt::runtime {

struct ReferenceOptions {
  PictureOptions picture;
  std::filesystem::path noise{};  ///< .exr of the standard error, RGB; empty: not wanted
  /// By brdf::kBrdfSyntax; unset: what the model's transfer was baked with, else lambert.
  std::optional<std::string> brdf{};
  int sample_count = 256;  ///< paths in a pixel
  int bounce_count = 2;    ///< interreflections; 0: direct light only
  bool full_map = false;   ///< the whole environment map, else its bands
  bool box_filter = true;  ///< the mean over the pixel's square, else its centre
  std::uint64_t seed = 1;
  CheckpointOptions checkpoint{};  ///< where to keep what is done; removed at the end
};

/// Adds to the report: stages, "brdf", "resumed_share", "rays_cast", "rays_per_second",
/// "sample_count" and "relative_standard_error" (of the picture: root mean square over root mean
/// square). Throws Error.
void render_reference(const ReferenceOptions& options, Report& report);

}  // namespace prt::runtime
