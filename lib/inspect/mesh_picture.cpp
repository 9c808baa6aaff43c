#include "inspect/mesh_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "camera/camera.h"
#include "inspect/canvas.h"

namespace prt::inspect {

namespace {

constexpr int kSamples = 2;  // a side of each pixel
constexpr float kFieldOfView = 30.0f;

/// A vertex on the image: pixels from the upper left, depth away from the eye.
struct Corner {
  float x, y, depth;
  Vec3 color;
};

/// Depth buffer and colours of samples.
class Raster {
 public:
  explicit Raster(int size)
      : size_(size),
        depth_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size),
               std::numeric_limits<float>::infinity()),
        colors_(depth_.size(), kWhite) {}

  void draw(const std::array<Corner, 3>& t, float shade, bool smooth) {
    const float area = edge(t[0], t[1], t[2].x, t[2].y);
    if (!(std::abs(area) > 0.0f)) return;
    const auto [x_low, x_high] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y_low, y_high] = std::minmax({t[0].y, t[1].y, t[2].y});
    for (int y = first(y_low); y <= last(y_high); ++y) {
      for (int x = first(x_low); x <= last(x_high); ++x) {
        const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
        const std::array<float, 3> b{edge(t[1], t[2], px, py) / area,
                                     edge(t[2], t[0], px, py) / area,
                                     edge(t[0], t[1], px, py) / area};
        if (b[0] < 0.0f || b[1] < 0.0f || b[2] < 0.0f) continue;
        const float depth = b[0] * t[0].depth + b[1] * t[1].depth + b[2] * t[2].depth;
        const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) +
                               static_cast<std::size_t>(x);
        if (depth >= depth_[at]) continue;
        depth_[at] = depth;
        const auto nearest =
            static_cast<std::size_t>(std::max_element(b.begin(), b.end()) - b.begin());
        colors_[at] = shade * (smooth ? t[0].color * b[0] + t[1].color * b[1] + t[2].color * b[2]
                                      : t[nearest].color);
      }
    }
  }

  Vec3 mean(int pixel_x, int pixel_y) const {
    Vec3 sum(0.0f);
    for (int i = 0; i < kSamples * kSamples; ++i) {
      const int x = pixel_x * kSamples + i % kSamples, y = pixel_y * kSamples + i / kSamples;
      sum += colors_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) +
                     static_cast<std::size_t>(x)];
    }
    return sum / static_cast<float>(kSamples * kSamples);
  }

 private:
  static float edge(const Corner& a, const Corner& b, float x, float y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
  }
  int first(float low) const { return std::max(static_cast<int>(std::floor(low)), 0); }
  int last(float high) const { return std::min(static_cast<int>(std::ceil(high)), size_ - 1); }

  int size_;
  std::vector<float> depth_;
  std::vector<Vec3> colors_;
};

}  // namespace

void draw_surface(Canvas& canvas, int left, int top, int size, const mesh::Scene& scene,
                  std::span<const Vec3> colors, const SurfaceView& view) {
  const int sample_size = size * kSamples;
  camera::Camera camera = camera::frame(camera::bounding_sphere(scene), kFieldOfView, 1.0f);
  if (view.is_from_behind) {
    const Vec3 offset = camera.eye - camera.target;
    camera.eye = camera.target + Vec3(-offset.x, offset.y, -offset.z);
  }
  const camera::Camera::Axes axes = camera.axes();
  const float scale = 0.5f * static_cast<float>(sample_size) /
                      std::tan(kFieldOfView * static_cast<float>(M_PI) / 360.0f);
  Raster raster(sample_size);
  std::size_t first_vertex = 0;
  for (const mesh::Primitive& primitive : scene.primitives) {
    const mesh::TriangleMesh& mesh = primitive.mesh;
    const auto corner = [&](std::uint32_t vertex) {
      const Vec3 p = mesh.positions[vertex] - camera.eye;
      const float depth = -p.dot(axes.backward);
      return Corner{0.5f * static_cast<float>(sample_size) + scale * p.dot(axes.right) / depth,
                    0.5f * static_cast<float>(sample_size) - scale * p.dot(axes.up) / depth, depth,
                    colors[first_vertex + vertex]};
    };
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
      const auto [a, b, c] = mesh.triangle(i);
      const Vec3 middle = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3.0f;
      const Vec3 normal = (mesh.normals[a] + mesh.normals[b] + mesh.normals[c]).normalized();
      const float facing = std::abs(normal.dot((camera.eye - middle).normalized()));
      raster.draw({corner(a), corner(b), corner(c)}, view.is_shaded ? 0.45f + 0.55f * facing : 1.0f,
                  view.is_smooth);
    }
    first_vertex += mesh.vertex_count();
  }
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) canvas.fill(left + x, top + y, 1, 1, raster.mean(x, y));
  }
}

image::Image draw_scene(const mesh::Scene& scene, std::span<const Vec3> colors,
                        const std::string& caption, int size) {
  Canvas canvas(size, size, kWhite);
  draw_surface(canvas, 0, 0, size, scene, colors, {});
  canvas.text(10, size - 18, caption, kBlack);
  return canvas.linear();
}

}  // namespace prt::inspect
