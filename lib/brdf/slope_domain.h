// The directions to the light that an eye sees reflected, by the slopes p = (x, y) / z of their
// half vectors h: where a lobe of microfacets is sharp and however anisotropic, it is smooth in
// coordinates that stretch the slopes by its widths and grow with their logarithm.
//
// For an eye v the light s = 2 (v·h) h - v is above the horizon where |p - v_xy/v_z| < 1/v_z: a
// disk, which holds p = 0. With p = (α_x q_x, α_y q_y), and q turned so that q_1 points to where
// the eye is as stretched, chords of the disk along q_1 are cut where they cross it,
//   q_2 = sinh a, q_1 = cosh a sinh b, dq = cosh² a cosh b da db,
// so that 1 + |q|² = cosh² a cosh² b, and a turns smoothly round at both ends, as sin τ.
#pragma once

#include "brdf/cubature.h"
#include "brdf/lobe.h"

namespace prt::brdf {

class SlopeDomain {
 public:
  /// `scale` are α_x and α_y, above 0; the eye is above the surface.
  SlopeDomain(const Imath::V2d& scale, const Direction& eye);

  struct Light {
    Direction direction;
    double density;  ///< solid angle (sr) per dτ dx
  };
  /// All x of one τ.
  class Chord {
   public:
    /// x in [0, 1].
    Light at(double x) const;

   private:
    friend class SlopeDomain;
    Direction eye_;
    Imath::V2d along_, start_;  // p = start_ + sinh b along_
    double low_, length_, density_;
  };
  /// τ in [-π/2, π/2], with the same lobe on both sides of 0 when the scale is isotropic.
  Chord chord(double tau) const;

 private:
  Direction eye_;
  Imath::V2d along_, across_;  // p = q_1 along + q_2 across
  double along2_, both_, across2_, area_, stretched_, middle_, half_;
};

}  // namespace prt::brdf
