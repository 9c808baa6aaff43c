// Pictures of values over a surface, drawn by the processor: no OpenGL.
#pragma once

#include <span>
#include <string>

#include "core/vec.h"
#include "image/image.h"
#include "mesh/scene.h"

namespace prt::inspect {

/// The scene as camera::frame shows it, on white, `size` pixels square, colours (display values,
/// one for each vertex) darkened away from the eye so that its shape can be read. `smooth`: colours
/// interpolated over triangles; else each point has the colour of the nearest corner, which shows
/// where clusters meet. The caption is one line. Linear values, as image::write_image takes them.
image::Image draw_scene(const mesh::Scene& scene, std::span<const Vec3> colors, bool smooth,
                        const std::string& caption, int size = 640);

}  // namespace prt::inspect
