// One picture against another, usually a drawn one against the path tracer's.
#pragma once

#include <filesystem>
#include <optional>

#include "core/report.h"
#include "image/image.h"
#include "inspect/inspection.h"

namespace prt::inspect {

struct ComparisonInput {
  image::Image image, reference;      ///< linear RGB or RGBA, of one size
  std::optional<image::Image> mask;   ///< first channel above 0.5: count the pixel
  std::optional<image::Image> noise;  ///< standard error of the reference, RGB
};

struct Comparison {
  Json json;                ///< key comparison of docs/tools/prt-inspect.md
  image::Image difference;  ///< one channel: ‖a - b‖ over RGB where counted, -1 elsewhere
};

/// Counts pixels whose alpha is 1 in both (images without alpha cover everything) and that the
/// mask allows. Relative RMSE is sqrt(Σ |a-b|²) / sqrt(Σ |b|²) over counted pixels and RGB, b being
/// the reference. Throws Error (bad_input) when sizes differ or no pixel counts.
Comparison compare(const ComparisonInput& input);

/// The difference in the linear blue-cyan-green-yellow-red scale of [Sloan03] Figure 4, 0 to
/// `scale` (in radiance), with a legend; grey where nothing was counted.
image::Image heatmap(const Comparison& comparison, double scale);

/// Empty: none.
struct ComparisonFiles {
  std::filesystem::path image, reference, mask, noise;
  std::filesystem::path heatmap;  ///< to be written
  double heatmap_max = 0.0;       ///< its scale; 0: the 99th percentile of the difference
};

/// Compares files, and adds image, reference and comparison to `json`; the stage, inputs and the
/// output to the report. Throws what compare, read_image and write_image throw.
void compare_files(const ComparisonFiles& files, bool no_clobber, Report& report, Json& json);

}  // namespace prt::inspect
