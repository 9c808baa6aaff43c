#include "brdf/lobe_matrix.h"

#include <gtest/gtest.h>

#include "all_lobes.h"
#include "core/parallel.h"
#include "sh/basis.h"
#include "sh/hemisphere.h"
#include "sh/quadrature.h"
#include "sh/zonal.h"

namespace prt::brdf {
namespace {

using std::numbers::pi;

std::vector<int> all_functions(int band_count) {
  return sh::hemisphere_functions(sh::coefficient_count(band_count));
}

int order_of(int i) { return i - sh::coefficient_index(static_cast<int>(std::sqrt(i)), 0); }

struct Node {
  Direction w;
  double weight;
};

/// A product rule over the hemisphere, Gauss in the polar angle.
std::vector<Node> hemisphere_nodes(int polar_count, int azimuth_count) {
  const sh::GaussLegendre rule(polar_count);
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double theta = (rule.nodes[i] + 1) * pi / 4;
    for (int j = 0; j < azimuth_count; ++j) {
      nodes.push_back({from_angles(theta, 2 * pi * (j + 0.5) / azimuth_count),
                       rule.weights[i] * pi / 4 * std::sin(theta) * 2 * pi / azimuth_count});
    }
  }
  return nodes;
}

std::vector<double> basis_at(int band_count, const Direction& w) {
  std::vector<double> values(sh::row_size(band_count));
  sh::evaluate(band_count, w.x, w.y, w.z, values);
  return values;
}

TEST(LobeMatrix, LambertIsTheClampedCosine) {
  const LobeMatrix matrix = compute_lobe_matrix(*lambert(), 4, 5, 1e-7);
  const int constant[] = {0};
  const auto rows = sh::hemisphere_gram(all_functions(4), constant);
  const auto lobe = sh::cosine_lobe(5);
  EXPECT_LE(matrix.error, 1e-7);
  ASSERT_EQ(matrix.values.size(), 16u * 25u);
  for (int i = 0; i < 16; ++i) {
    for (int l = 0; l < 5; ++l) {
      for (int m = -l; m <= l; ++m) {
        const double incident = m == 0 ? lobe[static_cast<std::size_t>(l)] / pi : 0;
        const double expected = rows[static_cast<std::size_t>(i)] * std::sqrt(4 * pi) * incident;
        const auto j = static_cast<std::size_t>(sh::coefficient_index(l, m));
        EXPECT_NEAR(matrix.values[static_cast<std::size_t>(i) * 25 + j], expected, 1e-7);
      }
    }
  }
  EXPECT_NEAR(matrix.kernel_energy, 2 * pi * (2 * pi / 3) / (pi * pi), 1e-6);
}

// By the addition theorem, cos^N of the angle between the eye and the mirrored light is a sum over
// bands of zonal coefficients Λ_l = 2π ∫ t^N P_l(t) dt over [0, 1], which vanish quickly for N =
// 10; mirroring multiplies functions by (-1)^m.
TEST(LobeMatrix, PhongFollowsFromItsZonalCoefficients) {
  constexpr int kBands = sh::kMaxBandCount, kExponent = 10;
  const sh::GaussLegendre rule(40);
  std::vector<double> zonal(kBands);
  for (std::size_t n = 0; n < rule.nodes.size(); ++n) {
    const double t = (rule.nodes[n] + 1) / 2;
    for (int l = 0; l < kBands; ++l) {
      zonal[static_cast<std::size_t>(l)] += pi * rule.weights[n] * std::pow(t, kExponent) *
                                            std::legendre(static_cast<unsigned>(l), t);
    }
  }
  const std::vector<int> many = all_functions(kBands);
  const auto rows = sh::hemisphere_gram(all_functions(5), many);
  std::vector<double> columns(many.size() * 36);  // ∫ y_k y_j z over the hemisphere
  for (const Node& node : hemisphere_nodes(30, 50)) {
    const auto values = basis_at(kBands, node.w);
    for (std::size_t k = 0; k < many.size(); ++k) {
      for (std::size_t j = 0; j < 36; ++j) {
        columns[k * 36 + j] += node.weight * node.w.z * values[k] * values[j];
      }
    }
  }
  const LobeMatrix matrix = compute_lobe_matrix(*phong(kExponent), 5, 6, 1e-6);
  EXPECT_LE(matrix.error, 1e-6);
  for (std::size_t i = 0; i < 25; ++i) {
    for (std::size_t j = 0; j < 36; ++j) {
      double expected = 0;
      for (std::size_t k = 0; k < many.size(); ++k) {
        const int l = static_cast<int>(std::sqrt(many[k]));
        expected += (order_of(many[k]) % 2 ? -1 : 1) * zonal[static_cast<std::size_t>(l)] *
                    rows[i * many.size() + k] * columns[k * 36 + j];
      }
      expected *= (kExponent + 2) / (2 * pi);
      ASSERT_NEAR(matrix.values[i * 36 + j], expected, 1e-6) << i << " " << j;
    }
  }
}

TEST(LobeMatrix, MatchesDenseQuadrature) {
  const auto nodes = hemisphere_nodes(56, 72);
  std::vector<std::vector<double>> columns;
  for (const Node& s : nodes) columns.push_back(basis_at(4, s.w));
  for (const auto& lobe : {ggx(0.7, 0.4), ggx(0.6, 0.6, Fresnel::one, Masking::height_correlated),
                           ashikhmin_shirley(3, 6, Fresnel::facing)}) {
    std::vector<double> expected(9 * 16);
    double kernel_energy = 0;
    for (const Node& v : nodes) {
      std::vector<double> moments(16);
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        const Node& s = nodes[n];
        const double kernel = lobe->evaluate(s.w, v.w) * s.w.z;
        for (std::size_t j = 0; j < 16; ++j) moments[j] += s.weight * kernel * columns[n][j];
        kernel_energy += v.weight * s.weight * kernel * kernel;
      }
      const auto values = basis_at(3, v.w);
      for (std::size_t i = 0; i < 9; ++i) {
        for (std::size_t j = 0; j < 16; ++j) {
          expected[i * 16 + j] += v.weight * values[i] * moments[j];
        }
      }
    }
    const LobeMatrix matrix = compute_lobe_matrix(*lobe, 3, 4, 1e-4);
    EXPECT_LE(matrix.error, 1e-4) << lobe->key();
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_NEAR(matrix.values[i], expected[i], 1e-4) << lobe->key() << " entry " << i;
    }
    EXPECT_NEAR(matrix.kernel_energy, kernel_energy, 2e-3 * kernel_energy) << lobe->key();
  }
}

// Sharp lobes, against the lobe's own sampler, which knows where its peak is.
TEST(LobeMatrix, MatchesMonteCarlo) {
  for (const auto& lobe :
       {ggx(0.05, 0.05, Fresnel::facing), ggx(0.25, 0.001), ward(0.1, 0.4), phong(200)}) {
    Pcg32 random(6);
    constexpr int kCount = 100000;
    std::vector<double> sums(16 * 9), squares(16 * 9);
    for (int n = 0; n < kCount; ++n) {
      const Direction eye = random_upper(random);
      const double u1 = random.uniform(), u2 = random.uniform();
      const Direction light = lobe->sample(eye, u1, u2);
      const double value = lobe->evaluate(light, eye);
      if (value == 0) continue;
      const double weight = 2 * pi * value * light.z / lobe->pdf(light, eye);
      const auto rows = basis_at(4, eye), columns = basis_at(3, light);
      for (std::size_t i = 0; i < 16; ++i) {
        for (std::size_t j = 0; j < 9; ++j) {
          const double term = weight * rows[i] * columns[j];
          sums[i * 9 + j] += term;
          squares[i * 9 + j] += term * term;
        }
      }
    }
    const LobeMatrix matrix = compute_lobe_matrix(*lobe, 4, 3, 1e-4);
    EXPECT_LE(matrix.error, 1e-4) << lobe->key();
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double mean = sums[i] / kCount;
      const double deviation = std::sqrt((squares[i] / kCount - mean * mean) / kCount);
      ASSERT_NEAR(matrix.values[i], mean, 5 * deviation + 1e-4) << lobe->key() << " entry " << i;
    }
  }
}

// A mirror reverses x and y: B = A with the signs of odd m changed. Phong's lobe darkens with the
// cosine, so that its limit has the factor z under the integral.
TEST(LobeMatrix, SmoothLobesTendToTheMirror) {
  const auto gram = sh::hemisphere_gram(all_functions(4), all_functions(4));
  std::vector<double> darkened(256);
  for (const Node& node : hemisphere_nodes(12, 20)) {
    const auto values = basis_at(4, node.w);
    for (std::size_t k = 0; k < 256; ++k) {
      darkened[k] += node.weight * node.w.z * values[k / 16] * values[k % 16];
    }
  }
  const auto expect = [](LobePointer lobe, const std::vector<double>& limit, double tolerance) {
    const LobeMatrix matrix = compute_lobe_matrix(*lobe, 4, 4, 1e-4);
    EXPECT_LE(matrix.error, 1e-4) << lobe->key();
    for (std::size_t k = 0; k < 256; ++k) {
      const int sign = order_of(static_cast<int>(k % 16)) % 2 ? -1 : 1;
      EXPECT_NEAR(matrix.values[k], sign * limit[k], tolerance) << lobe->key();
    }
  };
  expect(ggx(kMinAlpha, kMinAlpha), gram, 2e-3);
  expect(ashikhmin_shirley(1e6, 1e6), gram, 1e-2);
  expect(phong(1e6), darkened, 2e-3);
}

TEST(LobeMatrix, DoesNotDependOnTheNumberOfThreads) {
  set_thread_count(1);
  const LobeMatrix one = compute_lobe_matrix(*ggx(0.4, 0.8), 3, 3, 1e-3);
  set_thread_count(0);
  EXPECT_EQ(compute_lobe_matrix(*ggx(0.4, 0.8), 3, 3, 1e-3).values, one.values);
}

}  // namespace
}  // namespace prt::brdf
