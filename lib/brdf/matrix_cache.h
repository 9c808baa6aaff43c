// Lobe matrices kept on disk, each in a file named by the hash of what it depends on.
#pragma once

#include <filesystem>

#include "brdf/lobe_matrix.h"

namespace prt::brdf {

/// $XDG_CACHE_HOME/prtkit/brdf, else $HOME/.cache/prtkit/brdf; empty, which caches nothing, when
/// neither variable is an absolute path.
std::filesystem::path default_cache_folder();

/// compute_lobe_matrix(), or the same matrix read back bit for bit. A file that is broken or of
/// another lobe is ignored and replaced; one that cannot be written is only a message of -v.
LobeMatrix cached_lobe_matrix(const Lobe& lobe, int row_band_count, int column_band_count,
                              double tolerance = kMatrixTolerance,
                              const std::filesystem::path& folder = default_cache_folder());

}  // namespace prt::brdf
