// Errors of several encodings over a surface on one scale: [Sloan03] Figure 4.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "mesh/scene.h"

namespace prt::inspect {

struct EncodingError {
  std::string name;
  double squared_error = 0.0;    ///< SE of [Sloan03], over all vertices
  std::vector<double> relative;  ///< of each vertex, as CompressionError has it
};

/// A column for each encoding: its name with SE, the surface from the front and from behind in the
/// colours of image::heat_color, not shaded, and a histogram in the same; below, what the colours
/// stand for. Red is the greatest of the encodings' 99th percentiles, and more.
image::Image draw(const mesh::Scene& scene, std::span<const EncodingError> errors,
                  const std::string& title);

/// "vertex,NAME,NAME,..." and a line of relative errors for each vertex.
std::string to_csv(std::span<const EncodingError> errors);

}  // namespace prt::inspect
