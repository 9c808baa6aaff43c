// Geometry of one primitive, between its accessors and a TriangleMesh.
#pragma once

#include "gltf/model.h"
#include "mesh/triangle_mesh.h"

namespace prt::gltf {

/// Positions, normals, tangents, TEXCOORD_0 and COLOR_0 as they stand, in local space; indices made
/// for strips, fans and lists without. Throws Error (bad_input) for types that glTF forbids and for
/// indices past the last vertex.
mesh::TriangleMesh read_geometry(const Model& model, const tinygltf::Primitive& primitive,
                                 const Where& where);

/// Writes the mesh's attributes and indices into new accessors and makes `primitive` use them.
void write_geometry(State& state, Json& primitive, const mesh::TriangleMesh& mesh);

/// Throws Error (bad_input) when the transform flattens what it moves, or takes a position of the
/// mesh out of the range of floats.
void check_transform(const Matrix4& world_from_local, const mesh::TriangleMesh& mesh,
                     const Where& where);

}  // namespace prt::gltf
