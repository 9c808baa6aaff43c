#include "brdf/slope_domain.h"

#include <algorithm>
#include <cmath>

namespace prt::brdf {

namespace {

struct Roots {
  double low, high;
};

/// Of a x² + 2 b x + c, a > 0, without cancellation.
Roots roots(double a, double b, double c) {
  const double root = std::sqrt(std::max(0.0, b * b - a * c));
  if (b < 0) return {c / (root - b), (root - b) / a};
  const double q = -b - root;
  return {q / a, q < 0 ? c / q : 0};
}

}  // namespace

// The disk is v_z |p|² - 2 v_xy·p - v_z < 0, where v_xy·across = 0.
SlopeDomain::SlopeDomain(const Imath::V2d& scale, const Direction& eye) : eye_(eye) {
  const Imath::V2d stretched(scale.x * eye.x, scale.y * eye.y);
  stretched_ = stretched.length();
  const Imath::V2d n = stretched_ > 0 ? stretched / stretched_ : Imath::V2d(1, 0);
  along_ = Imath::V2d(scale.x * n.x, scale.y * n.y);
  across_ = Imath::V2d(-scale.x * n.y, scale.y * n.x);
  along2_ = along_ ^ along_, both_ = along_ ^ across_, across2_ = across_ ^ across_;
  area_ = scale.x * scale.y;
  const double z = eye.z;
  const Roots ends = roots(z * z * area_ * area_, stretched_ * z * both_,
                           -(stretched_ * stretched_ + z * z * along2_));
  const double low = std::asinh(ends.low), high = std::asinh(ends.high);
  middle_ = (low + high) / 2, half_ = (high - low) / 2;
}

SlopeDomain::Chord SlopeDomain::chord(double tau) const {
  const double a = middle_ + half_ * std::sin(tau), cosh_a = std::cosh(a), z = eye_.z;
  const double q2 = std::sinh(a);
  const Roots ends = roots(z * along2_, z * both_ * q2 - stretched_, z * (across2_ * q2 * q2 - 1));
  Chord chord;
  chord.eye_ = eye_;
  chord.along_ = along_ * cosh_a;
  chord.start_ = across_ * q2;
  chord.low_ = std::asinh(ends.low / cosh_a);
  chord.length_ = std::asinh(ends.high / cosh_a) - chord.low_;
  chord.density_ = 4 * area_ * cosh_a * cosh_a * chord.length_ * half_ * std::cos(tau);
  return chord;
}

// dp = α_x α_y dq, dh = h_z³ dp, ds = 4 (v·h) dh.
SlopeDomain::Light SlopeDomain::Chord::at(double x) const {
  const double e = std::exp(low_ + x * length_), sinh = (e - 1 / e) / 2, cosh = (e + 1 / e) / 2;
  const Imath::V2d slope = start_ + along_ * sinh;
  const double h_z = 1 / std::sqrt(1 + (slope ^ slope));
  const Direction h(slope.x * h_z, slope.y * h_z, h_z);
  const double cosine = eye_ ^ h;
  return {h * (2 * cosine) - eye_, density_ * std::abs(cosine) * h_z * h_z * h_z * cosh};
}

}  // namespace prt::brdf
