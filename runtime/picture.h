// From linear pixels to files, shared by everything that renders.
#pragma once

#include <filesystem>

#include "image/image.h"

namespace prt::runtime {

/// Throws Error (usage) unless it is finite and within 64 stops.
void check_exposure(float stops);

struct DevelopOptions {
  float exposure = 0.0f;     ///< stops
  bool tone_mapped = true;   ///< else colours are shown as they are, clamped
  bool transparent = false;  ///< keep alpha; else the picture is opaque
};

/// Display-linear picture of linear RGBA, premultiplied by alpha: 4 channels, alpha not
/// premultiplied, when transparent, else 3. Twin of composite.frag before the sRGB curve.
image::Image developed(const image::Image& linear, const DevelopOptions& options);

/// Writes linear RGBA: an .exr as it is, a .png developed.
void write_picture(const std::filesystem::path& path, const image::Image& linear,
                   const DevelopOptions& options, bool no_clobber);

}  // namespace prt::runtime
