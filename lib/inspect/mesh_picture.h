// Pictures of values over a surface, drawn by the processor: no OpenGL.
#pragma once

#include <span>
#include <string>

#include "core/vec.h"
#include "image/image.h"
#include "mesh/scene.h"

namespace prt::inspect {

class Canvas;

struct SurfaceView {
  bool is_smooth = false;       ///< colours interpolated over triangles; else of the nearest corner
  bool is_shaded = true;        ///< darkened away from the eye, so that the shape can be read
  bool is_from_behind = false;  ///< of the model; else as camera::frame shows it
};

/// The scene in a square of the canvas, on white. Colours are display values, one for each vertex.
void draw_surface(Canvas& canvas, int left, int top, int size, const mesh::Scene& scene,
                  std::span<const Vec3> colors, const SurfaceView& view);

/// The scene, shaded, `size` pixels square; each point has the colour of the nearest corner, which
/// shows where clusters meet. The caption is one line. Linear values, as image::write_image takes
/// them.
image::Image draw_scene(const mesh::Scene& scene, std::span<const Vec3> colors,
                        const std::string& caption, int size = 640);

}  // namespace prt::inspect
