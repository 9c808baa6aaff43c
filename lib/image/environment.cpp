#include "image/environment.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/error.h"
#include "core/log.h"

namespace prt::image {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr double kNegligible = 1e-3;  // share of a map that compression may leave negative

Vec3 direction_of(float longitude, float sin_latitude, float cos_latitude) {
  return {std::sin(longitude) * cos_latitude, sin_latitude, std::cos(longitude) * cos_latitude};
}

}  // namespace

Vec3 direction_from_latlong(float u, float v) {
  const float latitude = kPi * (0.5f - v);
  return direction_of(kPi * (1 - 2 * u), std::sin(latitude), std::cos(latitude));
}

Vec2 latlong_from_direction(const Vec3& direction) {
  const float longitude = std::atan2(direction.x, direction.z);
  const float latitude = std::atan2(direction.y, std::hypot(direction.x, direction.z));
  return {0.5f - longitude / (2 * kPi), 0.5f - latitude / kPi};
}

Image read_environment(const std::filesystem::path& path, std::size_t max_pixels) {
  const Image read = read_image(path, max_pixels);
  if (std::abs(read.width - 2 * read.height) > 1) {
    throw_bad_input("not a latitude-longitude map",
                    {.file = path.string(),
                     .found = fmt::format("{} x {} pixels", read.width, read.height),
                     .expected = "a width of twice the height"});
  }
  Image environment(read.width, read.height, 3);
  std::size_t negative_count = 0;
  double negative_sum = 0.0, sum = 0.0;
  const std::size_t texel_count = environment.pixels.size() / 3;
  const auto channel_count = static_cast<std::size_t>(read.channel_count);
  for (std::size_t i = 0; i < texel_count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = read.pixels[i * channel_count + (channel_count < 3 ? 0 : c)];
      negative_count += value < 0;
      (value < 0 ? negative_sum : sum) += std::abs(value);
      environment.pixels[3 * i + c] = std::max(value, 0.0f);
    }
  }
  if (negative_count > 0) {
    log::write(negative_sum > kNegligible * sum ? log::Level::warning : log::Level::debug,
               fmt::format("{}: {} negative values set to 0", path.string(), negative_count));
  }
  return environment;
}

Vec3 environment_radiance(const Image& environment, const Vec3& direction) {
  const Vec2 uv = latlong_from_direction(direction);
  const float x = uv.x * static_cast<float>(environment.width) - 0.5f;
  const float y = uv.y * static_cast<float>(environment.height) - 0.5f;
  const float x_floor = std::floor(x), y_floor = std::floor(y);
  const float fx = x - x_floor, fy = y - y_floor;
  Vec3 radiance(0);
  for (int j = 0; j < 2; ++j) {
    const int row = std::clamp(static_cast<int>(y_floor) + j, 0, environment.height - 1);
    for (int i = 0; i < 2; ++i) {
      const int column = (static_cast<int>(x_floor) + i + environment.width) % environment.width;
      const float* texel = environment.at(column, row);
      radiance += Vec3(texel[0], texel[1], texel[2]) * ((i ? fx : 1 - fx) * (j ? fy : 1 - fy));
    }
  }
  return radiance;
}

}  // namespace prt::image
