// Scenes whose light is known in closed form, for the tests of the path tracer.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "brdf/brdf.h"
#include "camera/camera.h"
#include "mesh/frame.h"
#include "mesh/scene.h"
#include "reference/path_tracer.h"
#include "sh/light.h"

namespace prt::reference {

inline constexpr float kPi = std::numbers::pi_v<float>;

inline const BandLimitedIllumination kWhite(sh::constant_light(1, Vec3(1.0f)));

/// A direction of the world in a frame.
inline brdf::Direction in_frame(const mesh::Frame& frame, const Vec3& w) {
  return {double{w.dot(frame.x)}, double{w.dot(frame.y)}, double{w.dot(frame.z)}};
}

inline int add_material(mesh::Scene& scene, const Vec3& albedo, bool double_sided = false) {
  mesh::Material material;
  material.base_color = Vec4(albedo.x, albedo.y, albedo.z, 1.0f);
  material.double_sided = double_sided;
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

/// A parallelogram with the given corner and edges; its front is on the side of a × b.
inline void add_quad(mesh::Scene& scene, const Vec3& corner, const Vec3& a, const Vec3& b,
                     int material) {
  mesh::Primitive primitive;
  primitive.material = material;
  primitive.mesh.positions = {corner, corner + a, corner + a + b, corner + b};
  primitive.mesh.normals.assign(4, a.cross(b).normalized());
  primitive.mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.primitives.push_back(primitive);
}

/// The part of the unit sphere whose angle from +Y is in [begin, end], seen from outside or inside.
inline void add_sphere(mesh::Scene& scene, float begin, float end, bool inside, int material) {
  constexpr std::uint32_t kRows = 96, kColumns = 192;
  mesh::Primitive primitive;
  primitive.material = material;
  mesh::TriangleMesh& mesh = primitive.mesh;
  for (std::uint32_t i = 0; i <= kRows; ++i) {
    for (std::uint32_t j = 0; j < kColumns; ++j) {
      const float theta = begin + (end - begin) * static_cast<float>(i) / kRows;
      const float phi = 2.0f * kPi * static_cast<float>(j) / kColumns;
      const Vec3 p(std::sin(theta) * std::sin(phi), std::cos(theta),
                   std::sin(theta) * std::cos(phi));
      mesh.positions.push_back(p);
      mesh.normals.push_back(inside ? -p : p);
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    if ((q - p).cross(r - p).length() < 1e-9f) return;  // at a pole
    if (inside) std::swap(b, c);
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (std::uint32_t i = 0; i < kRows; ++i) {
    for (std::uint32_t j = 0; j < kColumns; ++j) {
      const std::uint32_t a = i * kColumns + j, b = i * kColumns + (j + 1) % kColumns;
      add(a, a + kColumns, b);
      add(b, a + kColumns, b + kColumns);
    }
  }
  scene.primitives.push_back(primitive);
}

inline camera::Camera look(const Vec3& eye, const Vec3& target, float vertical_fov) {
  camera::Camera camera;
  camera.eye = eye;
  camera.target = target;
  camera.vertical_fov = vertical_fov;
  return camera;
}

inline Options small(int size, int samples, int bounces) {
  Options options;
  options.width = options.height = size;
  options.sample_count = samples;
  options.bounce_count = bounces;
  return options;
}

/// Calls check(x, y) for every pixel that is covered as a whole; fails when there is none.
inline void for_covered(const Result& result, const std::function<void(int, int)>& check) {
  int count = 0;
  for (int y = 0; y < result.radiance.height; ++y) {
    for (int x = 0; x < result.radiance.width; ++x) {
      if (result.radiance.at(x, y)[3] != 1.0f) continue;
      check(x, y);
      ++count;
    }
  }
  EXPECT_GT(count, 100);
}

/// Where the centre of a pixel meets the plane of the given normal through the origin.
inline Vec3 point_on_plane(const camera::Camera& camera, const Vec3& normal, int size, int x,
                           int y) {
  const Vec3 direction =
      camera.ray_direction((2.0f * static_cast<float>(x) + 1.0f) / static_cast<float>(size) - 1.0f,
                           1.0f - (2.0f * static_cast<float>(y) + 1.0f) / static_cast<float>(size));
  return camera.eye - direction * (camera.eye.dot(normal) / direction.dot(normal));
}

}  // namespace prt::reference
