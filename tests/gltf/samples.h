// Small scenes and files for the tests of lib/gltf.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "gltf/document.h"

namespace prt::gltf::samples {

/// Two triangles with texture coordinates and colours, in two primitives of different materials,
/// the first textured.
mesh::Scene scene();

/// A transfer of arbitrary numbers for `vertex_count` vertices.
PrecomputedTransfer transfer(std::size_t vertex_count, int cluster_count = 3,
                             int component_count = 5);

/// A triangle with indices as plain .gltf, its buffer a data URI of 36 + 6 bytes in two views; to
/// be broken in one place.
nlohmann::ordered_json triangle_json();

/// The document of a file "a.gltf" that holds it.
Document parse(const nlohmann::ordered_json& json);

}  // namespace prt::gltf::samples
