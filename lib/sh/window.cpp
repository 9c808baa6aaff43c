#include "sh/window.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "sh/basis.h"

namespace prt::sh {

namespace {

using std::numbers::pi;
constexpr int kDirectionCount = 16384;

/// Spiral points: equal shares of the sphere, the golden angle between two.
Vec3 direction(int i) {
  const double y = 1 - (2 * i + 1.0) / kDirectionCount;
  const double longitude = i * pi * (3 - std::sqrt(5.0));
  const double radius = std::sqrt(1 - y * y);
  return {static_cast<float>(radius * std::cos(longitude)), static_cast<float>(y),
          static_cast<float>(radius * std::sin(longitude))};
}

/// What each band alone adds to the radiance in each direction, over the channel's mean, so that
/// band 0 adds 1: channels with a positive mean × kDirectionCount × band_count.
std::vector<double> shares_of_bands(const Light& light) {
  const auto bands = static_cast<std::size_t>(light.band_count);
  const double band_0 = 0.5 / std::sqrt(pi);  // Y(0,0)
  std::vector<std::vector<double>> channels(3);
  std::vector<double> basis(static_cast<std::size_t>(coefficient_count(light.band_count)));
  for (int i = 0; i < kDirectionCount; ++i) {
    const Vec3 d = direction(i);
    evaluate(light.band_count, d.x, d.y, d.z, basis);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::vector<float>& coefficients = light.coefficients[c];
      if (bands == 0 || coefficients[0] <= 0) continue;
      for (int l = 0; l < light.band_count; ++l) {
        double sum = 0;
        for (int m = -l; m <= l; ++m) {
          const auto k = static_cast<std::size_t>(coefficient_index(l, m));
          sum += double{coefficients[k]} * basis[k];
        }
        channels[c].push_back(sum / (double{coefficients[0]} * band_0));
      }
    }
  }
  for (std::size_t c = 1; c < 3; ++c)
    channels[0].insert(channels[0].end(), channels[c].begin(), channels[c].end());
  return channels[0];
}

std::vector<double> diffusion_factors(int band_count, double strength) {
  std::vector<double> factors;
  for (int l = 0; l < band_count; ++l) factors.push_back(std::exp(-strength * l * (l + 1)));
  return factors;
}

double windowed_share(std::span<const double> bands, std::span<const double> factors) {
  double share = 0;
  for (std::size_t l = 0; l < factors.size(); ++l) share += bands[l] * factors[l];
  return share;
}

double minimum_over_mean(std::span<const double> shares, std::span<const double> factors) {
  double minimum = 1;
  for (std::size_t first = 0; first < shares.size(); first += factors.size())
    minimum = std::min(minimum, windowed_share(shares.subspan(first, factors.size()), factors));
  return minimum;
}

/// By bisection of its logarithm: heat that flows never lowers the minimum. At 2^8 only the mean is
/// left.
double least_strength(std::span<const double> shares, int band_count) {
  const auto is_enough = [&](double exponent) {
    const auto factors = diffusion_factors(band_count, std::exp2(exponent));
    return minimum_over_mean(shares, factors) >= -kRinging;
  };
  if (minimum_over_mean(shares, diffusion_factors(band_count, 0)) >= -kRinging) return 0;
  double weak = -24, strong = 8;
  while (strong - weak > 1e-3) {
    const double middle = (weak + strong) / 2;
    (is_enough(middle) ? strong : weak) = middle;
  }
  return std::exp2(strong);
}

std::vector<double> factors_of(Window window, int band_count, double strength) {
  if (window == Window::automatic) return diffusion_factors(band_count, strength);
  std::vector<double> factors;
  for (int l = 0; l < band_count; ++l) {
    const double x = pi * l / band_count;
    const double lanczos = l == 0 ? 1 : std::sin(x) / x;
    factors.push_back(window == Window::hann      ? (1 + std::cos(x)) / 2
                      : window == Window::lanczos ? lanczos
                                                  : 1);
  }
  return factors;
}

Ringing ringing_of(std::span<const double> shares, std::span<const double> factors) {
  const std::size_t channel_size = kDirectionCount * factors.size();
  std::vector<bool> negative(kDirectionCount);
  for (std::size_t first = 0; first < shares.size(); first += factors.size())
    if (windowed_share(shares.subspan(first, factors.size()), factors) < -kRinging)
      negative[first % channel_size / factors.size()] = true;
  const auto count = static_cast<double>(std::count(negative.begin(), negative.end(), true));
  return {minimum_over_mean(shares, factors), count / kDirectionCount};
}

}  // namespace

const std::string& name_of(Window window) {
  return std::find_if(kWindows.begin(), kWindows.end(),
                      [&](const auto& entry) { return entry.second == window; })
      ->first;
}

Ringing ringing_of(const Light& light) {
  return ringing_of(shares_of_bands(light), factors_of(Window::none, light.band_count, 0));
}

WindowedLight windowed(const Light& light, Window window) {
  const std::vector<double> shares = shares_of_bands(light);
  const double strength =
      window == Window::automatic ? least_strength(shares, light.band_count) : 0;
  const std::vector<double> factors = factors_of(window, light.band_count, strength);
  WindowedLight result{light, window, strength, ringing_of(shares, factors)};
  for (auto& channel : result.light.coefficients)
    for (int l = 0; l < light.band_count; ++l)
      for (int m = -l; m <= l; ++m) {
        float& value = channel[static_cast<std::size_t>(coefficient_index(l, m))];
        value = static_cast<float>(double{value} * factors[static_cast<std::size_t>(l)]);
      }
  return result;
}

}  // namespace prt::sh
