#include "compress/scaling.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace prt::compress {

namespace {

constexpr std::size_t kBlock = 1 << 16;
/// Weights of greater signals might leave the range of float.
constexpr int kGreatExponent = 64;

void multiply(std::span<float> values, std::span<const double> factors) {
  parallel_for(values.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    std::size_t factor = begin % factors.size();
    for (std::size_t i = begin; i < end; ++i) {
      values[i] = static_cast<float>(double{values[i]} * factors[factor]);
      if (++factor == factors.size()) factor = 0;
    }
  });
}

double greatest_magnitude(std::span<const float> values, std::span<const double> factors) {
  std::vector<double> greatest(block_count(values.size(), kBlock));
  parallel_for(values.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double value = std::abs(double{values[i]}) * factors[i % factors.size()];
      greatest[begin / kBlock] = std::max(greatest[begin / kBlock], value);
    }
  });
  return *std::max_element(greatest.begin(), greatest.end());
}

std::vector<double> inverse(std::span<const double> factors, int exponent) {
  std::vector<double> inverses;
  for (const double factor : factors) inverses.push_back(std::ldexp(1.0 / factor, exponent));
  return inverses;
}

}  // namespace

Scaling::Scaling(std::span<const float> signal, std::span<const float> coefficient_weights)
    : roots_(1, 1.0) {
  if (!coefficient_weights.empty()) {
    greatest_ = *std::max_element(coefficient_weights.begin(), coefficient_weights.end());
    roots_.clear();
    for (const float weight : coefficient_weights) roots_.push_back(std::sqrt(weight / greatest_));
  }
  const double greatest = greatest_magnitude(signal, roots_);
  if (greatest > 0.0) exponent_ = std::ilogb(greatest);
}

void Scaling::apply(std::span<float> rows) const {
  std::vector<double> factors;
  for (const double root : roots_) factors.push_back(std::ldexp(root, -exponent_));
  multiply(rows, factors);
}

void Scaling::undo(std::span<float> rows) const { multiply(rows, inverse(roots_, exponent_)); }

void Scaling::undo(cpca::WeightFormat format, cpca::Encoding& encoding) const {
  const bool in_weights = format == cpca::WeightFormat::float32 && exponent_ < kGreatExponent;
  undo(encoding.means);
  multiply(encoding.bases, inverse(roots_, in_weights ? 0 : exponent_));
  if (in_weights) multiply(encoding.weights, std::vector<double>{std::ldexp(1.0, exponent_)});
}

double Scaling::square() const { return std::ldexp(greatest_, 2 * exponent_); }

}  // namespace prt::compress
