// Pictures of a diffuse sphere with lamps near it, against what arrives at the point of each pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gl/context.h"
#include "runtime/light_field.h"
#include "runtime/models.h"
#include "runtime/pictures.h"

namespace prt::runtime {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kAlbedo = 0.5f;  // unshadowed() of no direction

/// Exit radiance of the unit sphere at `point`, which is its normal there too. A lamp with a radius
/// is summed over pieces of equal solid angle.
Vec3 lit_by(const NearLight& lamp, const Vec3& point) {
  const Vec3 to_lamp = lamp.position - point;
  const float distance = to_lamp.length();
  const Vec3 z = to_lamp / distance;
  if (lamp.radius == 0.0f)
    return lamp.color * (kAlbedo / kPi * std::max(0.0f, point.dot(z)) / (distance * distance));
  const Vec3 x = z.cross(std::abs(z.x) < 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0)).normalized();
  const Vec3 y = z.cross(x);
  constexpr int kRings = 12, kSectors = 24;
  const float sine = lamp.radius / distance, height = 1.0f - std::sqrt(1.0f - sine * sine);
  float sum = 0;
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSectors; ++j) {
      const float cosine = 1.0f - height * (static_cast<float>(i) + 0.5f) / kRings;
      const float angle = 2 * kPi * static_cast<float>(j) / kSectors;
      const Vec3 direction = z * cosine + (x * std::cos(angle) + y * std::sin(angle)) *
                                              std::sqrt(1.0f - cosine * cosine);
      sum += std::max(0.0f, point.dot(direction));
    }
  return lamp.color * (kAlbedo / kPi * 2 * kPi * height * sum / (kRings * kSectors));
}

/// The clamped cosine in five bands: what of a point light they can show.
float in_five_bands(float cosine) {
  const float square = cosine * cosine;
  return 0.25f + 0.5f * cosine + 5.0f / 32 * (3 * square - 1) -
         3.0f / 256 * (35 * square * square - 30 * square + 3);
}

/// Over the pixels of a picture: squared differences from the truth, those between a point's truth
/// and five bands of it, and the truth squared.
struct Errors {
  double drawn = 0, bands = 0, truth = 0;
  int count = 0;

  double relative() const { return std::sqrt(drawn / truth); }
  double relative_of_bands() const { return std::sqrt(bands / truth); }
};

Errors compare(const image::Image& image, const camera::Camera& camera, const NearLight& lamp) {
  Errors errors;
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column) {
      const Vec3 direction = camera.ray_direction((2 * static_cast<float>(column) + 1) / kWidth - 1,
                                                  1 - (2 * static_cast<float>(row) + 1) / kHeight);
      const float along = camera.eye.dot(direction);
      const float square = along * along - camera.eye.length2() + 1;
      if (square < 0.05f) continue;  // beside the sphere or at its outline
      const Vec3 point = camera.eye + direction * (-along - std::sqrt(square));
      const Vec3 truth = lit_by(lamp, point), to_lamp = lamp.position - point;
      const float distance = to_lamp.length(), cosine = point.dot(to_lamp) / distance;
      const float strength = kAlbedo / kPi * lamp.color.x / (distance * distance);
      errors.drawn += std::pow(image.at(column, row)[0] - truth.x, 2.0);
      errors.bands += std::pow(strength * (in_five_bands(cosine) - std::max(0.0f, cosine)), 2.0);
      errors.truth += std::pow(truth.x, 2.0);
      ++errors.count;
    }
  EXPECT_GT(errors.count, 500);
  return errors;
}

TEST(NearLight, LightsASphereLikeTheTruth) {
  const gl::HeadlessContext context;
  const mesh::Scene scene = scene_of({sphere(64, 128)});
  const Model model = make_model(scene, {}, unshadowed(scene, 5, {Vec3(0)}));
  Renderer renderer;
  renderer.set_model(model);
  renderer.set_lighting(lighting_from(sh::Light(5)));
  View view = view_of(model);
  view.draw = Draw::uncompressed;
  for (const float radius : {0.0f, 0.5f}) {
    const NearLight lamp{Vec3(1, 1.5f, 2), radius, Vec3(10)};
    const auto errors_of = [&](int grid_size) {
      renderer.set_near_lights({lamp}, grid_size);
      return compare(renderer.render(view, kWidth, kHeight, 1), view.camera, lamp);
    };
    const Errors middle = errors_of(1), coarse = errors_of(3), fine = errors_of(8);
    // The bands are all that a fine grid leaves; a lamp with a size rings less than a point. The
    // error of the blend falls with the square of the step, to a twelfth from 3 to 8 points.
    EXPECT_LT(fine.relative(), 1.1 * fine.relative_of_bands()) << radius;
    EXPECT_LT(fine.relative_of_bands(), 0.03);
    EXPECT_LT(coarse.relative(), 0.05) << radius;
    EXPECT_GT(middle.relative(), 0.25) << "the lamp is as good as distant";
  }
}

}  // namespace
}  // namespace prt::runtime
