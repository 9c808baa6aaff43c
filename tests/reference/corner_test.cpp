// Interreflection of two walls against radiosity.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/path_tracer.h"
#include "scenes.h"

namespace prt::reference {
namespace {

// Two unit squares that meet at a right angle, under constant light: radiosity on a fine grid.
class Corner {
 public:
  static constexpr int kCells = 64;

  Corner(const Vec3& floor_albedo, const Vec3& wall_albedo)
      : floor_albedo_(floor_albedo), wall_albedo_(wall_albedo) {}

  // Radiance that leaves the floor (z towards us) or the wall at distances `across`, `away`
  // from the corner of the common edge, after `bounces` interreflections.
  Vec3 radiance(bool on_floor, double across, double away, int bounces) const {
    double form_factor = 0.0;
    Vec3 reflected(0.0f);
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        const double s = (i + 0.5) / kCells, t = (j + 0.5) / kCells;
        const double square = (s - across) * (s - across) + t * t + away * away;
        const double k = t * away / (std::numbers::pi * square * square) / (kCells * kCells);
        form_factor += k;
        if (bounces > 0) reflected += other(!on_floor, i, j, bounces - 1) * static_cast<float>(k);
      }
    }
    const Vec3 sky(static_cast<float>(1.0 - form_factor));
    return (on_floor ? floor_albedo_ : wall_albedo_) * (sky + reflected);
  }

 private:
  // The same at the middle of a cell, kept once computed.
  const Vec3& other(bool on_floor, int i, int j, int bounces) const {
    auto& table = tables_[static_cast<std::size_t>(2 * bounces + on_floor)];
    if (table.empty()) {
      table.resize(kCells * kCells);
      for (int a = 0; a < kCells; ++a) {
        for (int b = 0; b < kCells; ++b) {
          table[static_cast<std::size_t>(a * kCells + b)] =
              radiance(on_floor, (a + 0.5) / kCells, (b + 0.5) / kCells, bounces);
        }
      }
    }
    return table[static_cast<std::size_t>(i * kCells + j)];
  }

  Vec3 floor_albedo_, wall_albedo_;
  mutable std::vector<Vec3> tables_[4];
};

mesh::Scene corner_scene(const Vec3& floor_albedo, const Vec3& wall_albedo) {
  mesh::Scene scene;
  add_quad(scene, {0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f},
           add_material(scene, floor_albedo));
  add_quad(scene, {0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f},
           add_material(scene, wall_albedo));
  return scene;
}

TEST(PathTracer, BouncesInAColouredCornerMatchRadiosity) {
  const Vec3 floor_albedo(0.9f, 0.7f, 0.5f), wall_albedo(0.9f, 0.1f, 0.4f);
  const mesh::Scene scene = corner_scene(floor_albedo, wall_albedo);
  const Corner corner(floor_albedo, wall_albedo);
  // Floor from x, z in 0.2 to 0.8: there the grid resolves the kernel.
  const auto camera = look({0.5f, 3.0f, 0.5001f}, {0.5f, 0.0f, 0.5f}, 11.4f);
  constexpr int kSize = 12;
  for (int bounces = 0; bounces <= 2; ++bounces) {
    const Result result = trace(scene, camera, kWhite, small(kSize, 4096, bounces));
    double difference = 0.0, square = 0.0, noise = 0.0, count = 0.0;
    for_covered(result, [&](int x, int y) {
      const Vec3 p = point_on_plane(camera, {0.0f, 1.0f, 0.0f}, kSize, x, y);
      const Vec3 expected = corner.radiance(true, p.x, p.z, bounces);
      for (int c = 0; c < 3; ++c) {
        difference += result.radiance.at(x, y)[c] - expected[c];
        square += std::pow(result.radiance.at(x, y)[c] - expected[c], 2);
        noise += std::pow(result.standard_error.at(x, y)[c], 2);
        ++count;
      }
    });
    // Channels share their paths, so that the mean is as certain as that of a third as many.
    EXPECT_NEAR(difference / count, 0.0, 4.0 * std::sqrt(3.0 * noise) / count + 1e-4) << bounces;
    EXPECT_NEAR(square / noise, 1.0, 0.35) << bounces;
    EXPECT_LT(std::sqrt(noise / count), 2e-3);
  }
}

}  // namespace
}  // namespace prt::reference
