#include "ray/beams.h"

#include <algorithm>
#include <cmath>

namespace prt::ray {

namespace {

/// The beam of directions `first` to `first + count`, all on one face.
Beam make_beam(const PlanarDirections& directions, std::size_t first, std::size_t count) {
  Beam beam{};
  beam.first = static_cast<std::uint32_t>(first);
  beam.lane_count = static_cast<std::uint16_t>(count);
  beam.u_min = beam.v_min = 1.0f, beam.u_max = beam.v_max = -1.0f;
  for (std::size_t lane = 0; lane < kBeamLanes; ++lane) {
    const std::size_t i = first + std::min(lane, count - 1);
    const Vec3 d(directions.x[i], directions.y[i], directions.z[i]);
    const CubePlace place = cube_place(d);
    beam.x[lane] = d.x, beam.y[lane] = d.y, beam.z[lane] = d.z;
    beam.u[lane] = place.u, beam.v[lane] = place.v;
    beam.u_min = std::min(beam.u_min, place.u), beam.u_max = std::max(beam.u_max, place.u);
    beam.v_min = std::min(beam.v_min, place.v), beam.v_max = std::max(beam.v_max, place.v);
    beam.axis = static_cast<std::uint8_t>(place.face / 2);
    beam.negative = place.face % 2 != 0;
  }
  return beam;
}

}  // namespace

CubePlace cube_place(const Vec3& direction) {
  int m = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(direction[axis]) > std::abs(direction[m])) m = axis;
  }
  const float length = std::abs(direction[m]);
  return {2 * m + (direction[m] < 0.0f), direction[(m + 1) % 3] / length,
          direction[(m + 2) % 3] / length};
}

std::vector<Beam> make_beams(const PlanarDirections& directions) {
  const auto face = [&](std::size_t i) {
    return cube_place({directions.x[i], directions.y[i], directions.z[i]}).face;
  };
  std::vector<Beam> beams;
  for (std::size_t first = 0, end = 0; first < directions.x.size(); first = end) {
    const std::size_t limit = std::min(directions.x.size(), first + kBeamLanes);
    for (end = first + 1; end < limit && face(end) == face(first);) ++end;
    beams.push_back(make_beam(directions, first, end - first));
  }
  return beams;
}

}  // namespace prt::ray
