#include "sh/light.h"

#include "image/environment.h"
#include "inspect/inspection.h"
#include "inspect/statistics.h"
#include "sh/basis.h"

namespace prt::inspect {

namespace {

// Radiance is looked up at the texels of a map of this height: about a degree apart.
constexpr int kGridHeight = 180;

Vec3 coefficient(const sh::Light& light, int index) {
  const auto i = static_cast<std::size_t>(index);
  return {light.coefficients[0][i], light.coefficients[1][i], light.coefficients[2][i]};
}

}  // namespace

void inspect_light(const std::filesystem::path& path, Inspection& inspection) {
  const sh::Light light = sh::read_light(path);
  Json energy = Json::array();
  for (int l = 0; l < light.band_count; ++l) {
    double sum = 0.0;
    for (int m = -l; m <= l; ++m) {
      const Vec3 c = coefficient(light, sh::coefficient_index(l, m));
      sum += c.dot(c);
    }
    energy.push_back(sum);
  }
  std::vector<float> values;
  Vec3 brightest;
  float highest = -INFINITY;
  for (int y = 0; y < kGridHeight; ++y) {
    for (int x = 0; x < 2 * kGridHeight; ++x) {
      const Vec3 direction =
          image::direction_from_latlong((static_cast<float>(x) + 0.5f) / (2 * kGridHeight),
                                        (static_cast<float>(y) + 0.5f) / kGridHeight);
      const Vec3 radiance = sh::light_radiance(light, direction);
      values.insert(values.end(), {radiance.x, radiance.y, radiance.z});
      const float sum = radiance.x + radiance.y + radiance.z;
      if (sum > highest) {
        highest = sum;
        brightest = direction;
      }
    }
  }
  const Json range = range_of(values);
  // The mean over the sphere is band 0 alone, where Y is 1 / sqrt(4 pi).
  const Vec3 mean = light.band_count > 0 ? coefficient(light, 0) * 0.28209479f : Vec3(0.0f);
  inspection.json["light"] = {
      {"band_count", light.band_count}, {"source", light.source},
      {"mean_radiance", to_json(mean)}, {"radiance_min", range["min"]},
      {"radiance_max", range["max"]},   {"brightest_direction", to_json(brightest)},
      {"energy_per_band", energy}};
  if (range["min"] < 0.0) {
    inspection.warning("radiance", "negative in places: ringing of the band limit");
  }
}

}  // namespace prt::inspect
