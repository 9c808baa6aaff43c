#include "mesh/frame.h"

namespace prt::mesh {

namespace {

Vec3 flattened(const Vec3& v, const Vec3& normal) { return v - normal * normal.dot(v); }

}  // namespace

Frame frame_at_vertex(const TriangleMesh& mesh, std::size_t vertex) {
  const Vec3 z = mesh.normals[vertex].normalized();
  Vec3 x(0.0f);
  float side = 1.0f;
  if (!mesh.tangents.empty()) {
    const Vec4& tangent = mesh.tangents[vertex];
    x = flattened(Vec3(tangent.x, tangent.y, tangent.z), z);
    side = tangent.w < 0.0f ? -1.0f : 1.0f;
  }
  if (!(x.length() > 1e-3f)) {
    x = flattened(flattened(Vec3(1, 0, 0), z).length() > 0.1f ? Vec3(1, 0, 0) : Vec3(0, 0, 1), z);
    side = 1.0f;
  }
  x.normalize();
  return {x, z.cross(x) * side, z};
}

}  // namespace prt::mesh
