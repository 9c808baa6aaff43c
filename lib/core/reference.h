// Files that a file names: a material library, a buffer, a texture. A hostile name must not reach
// out of the folder that the naming file is in.
#pragma once

#include <filesystem>
#include <string_view>

namespace prt {

enum class Escapes { none, percent };  ///< glTF's URIs are percent-encoded, names in OBJ are not

/// The real path of what `file` names by `reference`, without links, so that what was checked is
/// what the caller opens. Throws Error (bad_input) when the name is empty, absolute, has a scheme
/// (or a drive letter) or a ".." part, whether written plainly, with backslashes or
/// percent-encoded. Links are followed as long as they lead to something in the same folder.
std::filesystem::path resolve_reference(const std::filesystem::path& file,
                                        std::string_view reference, Escapes escapes);

}  // namespace prt
