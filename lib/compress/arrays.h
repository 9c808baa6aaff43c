// An encoding as plain arrays, for those who compress signals of their own.
#pragma once

#include <filesystem>

#include "cpca/encoding.h"
#include "cpca/search_choice.h"

namespace prt::compress {

/// What the file of save_arrays takes, to the byte.
cpca::StorageCost cost_in_arrays(int cluster_count = 1);

/// Writes the .npz file of docs/tools/prt-compress.md, "Signals of your own". Throws Error
/// (failed).
void save_arrays(const std::filesystem::path& path, const cpca::Encoding& encoding,
                 bool no_clobber);

}  // namespace prt::compress
