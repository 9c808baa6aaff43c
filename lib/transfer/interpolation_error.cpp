#include "transfer/interpolation_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "core/stopwatch.h"
#include "sh/basis.h"
#include "transfer/buried.h"
#include "transfer/clamped_cosine.h"
#include "transfer/hemisphere.h"

namespace prt::transfer {

namespace {

constexpr int kBandCount = 5;
constexpr std::size_t kDirectionCount = 1024;
constexpr std::size_t kMostPoints = 256, kLeastPoints = 1;  // of a primitive
constexpr std::size_t kAllPoints = 4096;                    // about, of many primitives
constexpr std::size_t kPointBlock = 16;

struct Probe {
  std::size_t triangle;
  std::array<float, 3> barycentric;
};

/// Numbers of the triangles of a primitive, numbered through.
struct TriangleRange {
  std::size_t begin, end;
};

double area(const SceneIndex& index, std::size_t triangle) {
  const auto [a, b, c] = index.triangle(triangle);
  const Vec3 origin = index.position(a);
  return 0.5 * double{(index.position(b) - origin).cross(index.position(c) - origin).length()};
}

std::array<float, 3> point_of_triangle(Pcg32& random) {
  float u = random.uniform(), v = random.uniform();
  if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
  return {1.0f - u - v, u, v};
}

/// Of all the area, `count` points at equal distances along the list of triangles.
void add_probes(const SceneIndex& index, TriangleRange range, std::size_t count,
                std::vector<Probe>& probes) {
  Pcg32 random(range.begin);
  double total = 0.0, before = 0.0;
  for_each_trimmed(range.end - range.begin,
                   [&](std::size_t i) { total += area(index, range.begin + i); });
  const double step = total / static_cast<double>(count);
  double next = step / 2;
  for_each_trimmed(range.end - range.begin, [&](std::size_t i) {
    before += area(index, range.begin + i);
    for (; next < before; next += step)
      probes.push_back({range.begin + i, point_of_triangle(random)});
  });
}

struct Sums {
  double error = 0.0, energy = 0.0;
};

class Prober {
 public:
  explicit Prober(const SceneIndex& index)
      : index_(index),
        directions_(make_directions(kDirectionCount, 1)),
        basis_(basis_rows(kBandCount, directions_)) {}

  /// Nothing where the point or a corner is buried.
  Sums compare(const Probe& probe, Hemisphere& hemisphere) const {
    const std::array<std::uint32_t, 3> corners = index_.triangle(probe.triangle);
    Row interpolated{}, row{};
    Vec3 position(0.0f), normal(0.0f);
    float magnitude = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      hemisphere.trace(corners[k]);
      if (!find_irradiance(hemisphere, index_.normal(corners[k]), row)) return {};
      const float weight = probe.barycentric[k];
      for (std::size_t j = 0; j < kCount; ++j) interpolated[j] += weight * row[j];
      position += weight * index_.position(corners[k]);
      normal += weight * index_.normal(corners[k]);
      magnitude = std::max(magnitude, index_.magnitude(corners[k]));
    }
    if (normal.length() == 0.0f) return {};
    normal.normalize();
    hemisphere.trace(ray::offset_origin(position, facing(corners, normal), magnitude), normal);
    if (!find_irradiance(hemisphere, normal, row)) return {};
    Sums sums;
    for (std::size_t j = 0; j < kCount; ++j) {
      const double difference = double{row[j]} - double{interpolated[j]};
      sums.error += difference * difference;
      sums.energy += double{row[j]} * double{row[j]};
    }
    return sums;
  }

  Hemisphere hemisphere() const { return {index_, directions_}; }

 private:
  static constexpr std::size_t kCount = kBandCount * kBandCount;
  using Row = std::array<float, padded(kCount)>;

  /// Of what was traced last; false where that sees nothing.
  bool find_irradiance(const Hemisphere& hemisphere, const Vec3& normal, Row& row) const {
    if (sees_nothing(hemisphere)) return false;
    Row blocked{};
    add_weighted_rows(hemisphere.blocked(), basis_.data(), blocked.size(), blocked.data());
    clamped_cosine(kBandCount, normal, {row.data(), kCount});
    const float weight = 4.0f * std::numbers::pi_v<float> / kDirectionCount;
    for (std::size_t j = 0; j < kCount; ++j) row[j] -= weight * blocked[j];
    return true;
  }

  /// Of the triangle's two normals that on the side of the interpolated one.
  Vec3 facing(const std::array<std::uint32_t, 3>& corners, const Vec3& normal) const {
    const Vec3 origin = index_.position(corners[0]);
    const Vec3 across =
        (index_.position(corners[1]) - origin).cross(index_.position(corners[2]) - origin);
    return across.normalized() * (across.dot(normal) < 0.0f ? -1.0f : 1.0f);
  }

  const SceneIndex& index_;
  Directions directions_;
  std::vector<float> basis_;
};

double longest_edge(const mesh::TriangleMesh& mesh) {
  float longest = 0.0f;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::array<std::uint32_t, 3> corners = mesh.triangle(t);
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(
          longest, (mesh.positions[corners[k]] - mesh.positions[corners[(k + 1) % 3]]).length());
  }
  return longest;
}

}  // namespace

std::vector<double> interpolation_errors(const SceneIndex& index) {
  const std::vector<mesh::Primitive>& primitives = index.scene().primitives;
  const std::size_t point_count = std::clamp(
      kAllPoints / std::max(primitives.size(), std::size_t{1}), kLeastPoints, kMostPoints);
  std::vector<Probe> probes;
  std::vector<std::size_t> ends;  // of the probes of each primitive
  std::size_t first = 0;
  for (const mesh::Primitive& primitive : primitives) {
    const TriangleRange range{first, first + primitive.mesh.triangle_count()};
    add_probes(index, range, point_count, probes);
    ends.push_back(probes.size());
    first = range.end;
  }
  const Prober prober(index);
  std::vector<Sums> sums(probes.size());
  parallel_for(probes.size(), kPointBlock, [&](std::size_t begin, std::size_t end) {
    Hemisphere hemisphere = prober.hemisphere();
    for (std::size_t i = begin; i < end; ++i) sums[i] = prober.compare(probes[i], hemisphere);
  });
  std::vector<double> errors;
  std::size_t i = 0;
  for (const std::size_t end : ends) {
    Sums total;
    for (; i < end; ++i) {
      total.error += sums[i].error;
      total.energy += sums[i].energy;
    }
    errors.push_back(total.energy > 0.0 ? std::sqrt(total.error / total.energy) : 0.0);
  }
  return errors;
}

void measure_interpolation(const SceneIndex& index, DiffuseStats& stats) {
  const Stopwatch watch;
  const std::vector<double> errors = interpolation_errors(index);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    stats.primitives[i].interpolation_error = errors[i];
    stats.primitives[i].longest_edge = longest_edge(index.scene().primitives[i].mesh);
  }
  stats.interpolation_seconds = watch.seconds();
}

}  // namespace prt::transfer
