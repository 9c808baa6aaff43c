// An encoding as plain arrays, for those who compress signals of their own.
#pragma once

#include <filesystem>

#include "cpca/encoding.h"

namespace prt::compress {

/// Writes the .npz file of docs/tools/prt-compress.md, "Signals of your own". Throws Error
/// (failed).
void save_arrays(const std::filesystem::path& path, const cpca::Encoding& encoding,
                 bool no_clobber);

}  // namespace prt::compress
