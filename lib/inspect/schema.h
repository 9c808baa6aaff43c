// The JSON schemas of our glTF extension, compiled in from docs/extensions, and the check against
// them (valijson behind it).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace prt::inspect {

/// What in a .glb or .gltf breaks the schemas of PRTKIT_precomputed_transfer, a line each; empty
/// for a file without it. Throws Error (bad_input) when the file holds no JSON.
std::vector<std::string> schema_violations(const std::filesystem::path& path);

}  // namespace prt::inspect
