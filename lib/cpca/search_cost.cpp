#include "cpca/search_cost.h"

#include <algorithm>

namespace prt::cpca {

namespace {

/// As the iterative encoder does it without axes (cpca/iterative_encoder.cpp): passes over all
/// clusters, the others are over near ones; power steps. And alternations of the adaptive one, for
/// each iteration, one of five over all clusters.
constexpr double kFullPasses = 2.0, kNear = 16.0, kPowerSteps = 2.0, kAlternationsEach = 2.0,
                 kFullShare = 0.2;
/// Of one cluster, or exact ones: nothing moves.
constexpr int kSettled = 3;

/// For each point and coefficient.
double level_work(const Choice& choice, int vectors, int iterations) {
  const double all = choice.cluster_count, near = std::min(kNear, all),
               count = static_cast<double>(vectors) + 1.0;
  const double full = vectors == 0 ? iterations : std::min<double>(kFullPasses, iterations);
  return count * (2.0 * (full * all + (iterations - full) * near) + 4.0 * kPowerSteps * iterations);
}

double adaptation_work(const Choice& choice, int iterations) {
  const double all = choice.cluster_count, near = std::min(kNear, all),
               vectors = choice.component_count;
  return kAlternationsEach * iterations *
         (2.0 * (vectors + 1.0) * (kFullShare * all + (1.0 - kFullShare) * near) +
          4.0 * kPowerSteps * 2.0 * vectors);
}

double static_work(const Size& size, const Choice& choice, int iterations) {
  const double points = static_cast<double>(size.point_count) / choice.cluster_count;
  const double components =
      choice.component_count > 0
          ? choice.component_count + std::min(points, static_cast<double>(size.dimension))
          : 0.0;
  return 2.0 * (static_cast<double>(iterations) * choice.cluster_count + components);
}

}  // namespace

double encoding_work(Method method, const Size& size, const Choice& choice, int iterations) {
  if (choice.cluster_count == 1) iterations = std::min(iterations, kSettled);
  double work = 0.0;
  if (method == Method::fixed) {
    work = static_work(size, choice, iterations);
  } else {
    for (int i = 0; i <= choice.component_count; ++i) work += level_work(choice, i, iterations);
    if (method == Method::adaptive) work += adaptation_work(choice, iterations);
  }
  return static_cast<double>(size.point_count * size.dimension) * work;
}

double warm_work(Method method, const Size& size, const Choice& choice, int iterations) {
  if (method == Method::fixed) return encoding_work(method, size, choice, iterations);
  double work = level_work(choice, choice.component_count, iterations);
  if (method == Method::adaptive) work += adaptation_work(choice, iterations);
  return static_cast<double>(size.point_count * size.dimension) * work;
}

double equal_rows_work(const Size& size, const Choice& choice) {
  return encoding_work(Method::fixed, size, choice, kSettled);
}

void CostModel::learn(const Choice& choice, bool is_warm, const Effort& effort) {
  if (!is_warm || rate_ == 0.0) rate_ = effort.encoding / work(choice, is_warm);
  if (effort.encoding > 0.0) {
    tightening_share_ = effort.tightening / (rate_ * work(choice, false));
  }
}

double CostModel::alone(const Choice& choice) const {
  return (1.0 + tightening_share_) * rate_ * work(choice, false);
}

double CostModel::next(const Choice& choice, bool is_warm) const {
  return rate_ * (work(choice, is_warm) + tightening_share_ * work(choice, false));
}

double CostModel::alone(const Choice& choice, bool is_warm, const Effort& effort) const {
  return is_warm ? rate_ * work(choice, false) + effort.tightening : effort.total();
}

}  // namespace prt::cpca
