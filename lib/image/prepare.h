// An image file that is complete but not yet there, to be committed together with other outputs.
#pragma once

#include <memory>

#include "core/atomic_file.h"
#include "image/image.h"

namespace prt::image {

/// What write_image writes, up to the commit. Throws Error.
std::unique_ptr<AtomicFile> prepare_image(const std::filesystem::path& path, const Image& image,
                                          bool no_clobber = false);

}  // namespace prt::image
