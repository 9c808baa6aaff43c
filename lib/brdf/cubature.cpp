#include "brdf/cubature.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace prt::brdf {

namespace {

struct Rule {
  double node, kronrod, gauss;
};

constexpr std::array<Rule, 15> make_rule() {
  constexpr double kNode[] = {
      0.991455371120812639, 0.949107912342758525, 0.864864423359769073, 0.741531185599394440,
      0.586087235467691130, 0.405845151377397167, 0.207784955007898468, 0};
  constexpr double kKronrod[] = {0.022935322010529225, 0.063092092629978553, 0.104790010322250184,
                                 0.140653259715525919, 0.169004726639267903, 0.190350578064785410,
                                 0.204432940075298892, 0.209482141084727828};
  constexpr double kGauss[] = {0, 0.129484966168869693, 0, 0.279705391489276668,
                               0, 0.381830050505118945, 0, 0.417959183673469388};
  std::array<Rule, 15> rule{};
  for (std::size_t i = 0; i < 8; ++i) {
    rule[i] = {-kNode[i], kKronrod[i], kGauss[i]};
    rule[14 - i] = {kNode[i], kKronrod[i], kGauss[i]};
  }
  return rule;
}

constexpr std::array<Rule, 15> kRule = make_rule();
constexpr std::array<Rule, 1> kSingle = {{{0, 1, 1}}};

struct Piece {
  Box box;
  std::vector<double> values;
  double error = 0;
  bool split_x = true;

  bool operator<(const Piece& other) const { return error < other.error; }
};

// Differences of the product of Kronrod rules to three others: Gauss in both directions is the
// error, Gauss in one direction tells which to split.
class Estimator {
 public:
  Estimator(const Integrand& integrand, const CubatureOptions& options)
      : integrand_(integrand), options_(options) {}

  Piece operator()(const Box& box) {
    const bool flat = box.y0 == box.y1;
    const std::span<const Rule> x_rule(kRule);
    const std::span<const Rule> y_rule = flat ? std::span<const Rule>(kSingle) : x_rule;
    const double x_half = (box.x1 - box.x0) / 2, y_half = flat ? 1 : (box.y1 - box.y0) / 2;
    points_.clear();
    for (const Rule& x : x_rule) {
      for (const Rule& y : y_rule) {
        points_.push_back(
            {box.x0 + x_half * (1 + x.node), flat ? box.y0 : box.y0 + y_half * (1 + y.node)});
      }
    }
    values_.assign(points_.size() * options_.value_count, 0);
    integrand_(points_, values_);
    return sum(box, x_rule, y_rule, x_half * y_half);
  }

 private:
  Piece sum(const Box& box, std::span<const Rule> x_rule, std::span<const Rule> y_rule,
            double area) const {
    const std::size_t count = options_.value_count;
    std::vector<double> kronrod(count), gauss(count), gauss_x(count), gauss_y(count);
    const double* value = values_.data();
    for (const Rule& x : x_rule) {
      for (const Rule& y : y_rule) {
        for (std::size_t i = 0; i < count; ++i, ++value) {
          kronrod[i] += *value * (x.kronrod * y.kronrod);
          gauss[i] += *value * (x.gauss * y.gauss);
          gauss_x[i] += *value * (x.gauss * y.kronrod);
          gauss_y[i] += *value * (x.kronrod * y.gauss);
        }
      }
    }
    const auto difference = [&](const std::vector<double>& other) {
      double largest = 0;
      for (std::size_t i = 0; i < options_.controlled_count; ++i) {
        largest = std::max(largest, std::abs(kronrod[i] - other[i]));
      }
      return largest * area;
    };
    Piece piece{box, {}, difference(gauss), difference(gauss_x) >= difference(gauss_y)};
    for (double& k : kronrod) k *= area;
    piece.values = std::move(kronrod);
    return piece;
  }

  const Integrand& integrand_;
  const CubatureOptions& options_;
  std::vector<Point> points_;
  std::vector<double> values_;
};

std::array<Box, 2> halves(const Piece& piece) {
  Box low = piece.box, high = piece.box;
  if (piece.split_x) {
    low.x1 = high.x0 = (low.x0 + low.x1) / 2;
  } else {
    low.y1 = high.y0 = (low.y0 + low.y1) / 2;
  }
  return {low, high};
}

}  // namespace

CubatureResult integrate(std::span<const Box> boxes, const Integrand& integrand,
                         const CubatureOptions& options) {
  assert(options.controlled_count <= options.value_count);
  Estimator estimate(integrand, options);
  std::vector<Piece> heap;  // greatest error first
  double error = 0;
  for (const Box& box : boxes) {
    heap.push_back(estimate(box));
    error += heap.back().error;
  }
  std::make_heap(heap.begin(), heap.end());
  while (error > options.tolerance && heap.size() < options.max_box_count) {
    std::pop_heap(heap.begin(), heap.end());
    const Piece worst = std::move(heap.back());
    heap.pop_back();
    error -= worst.error;
    for (const Box& half : halves(worst)) {
      heap.push_back(estimate(half));
      error += heap.back().error;
      std::push_heap(heap.begin(), heap.end());
    }
  }
  CubatureResult result{std::vector<double>(options.value_count), error,
                        error <= options.tolerance};
  for (const Piece& piece : heap) {
    for (std::size_t i = 0; i < options.value_count; ++i) result.values[i] += piece.values[i];
  }
  return result;
}

}  // namespace prt::brdf
