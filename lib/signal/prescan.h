// OpenEXR takes memory for what a header claims before it looks whether the file holds it. This
// walks over the header first.
#pragma once

#include <filesystem>

namespace prt::signal {

/// Throws Error (bad_input) when an attribute is longer than the file, or when the data window has
/// more scanlines than the file has room for their offsets. Leaves everything else to OpenEXR.
void prescan_header(const std::filesystem::path& path);

}  // namespace prt::signal
