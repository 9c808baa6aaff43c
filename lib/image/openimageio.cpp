#include "image/openimageio.h"

#include <dlfcn.h>

#include <string>
#include <string_view>

#include "core/error.h"

namespace prt::image {

namespace {

const OpenImageIo& load() {
  constexpr const char* kFile = "prtkit_openimageio.so";  // found by the run path of the program
  void* library = dlopen(kFile, RTLD_LAZY | RTLD_LOCAL);
  const void* calls = library ? dlsym(library, "prtkit_openimageio") : nullptr;
  if (!calls) throw_failed("OpenImageIO cannot be loaded", {.found = dlerror()});
  const auto& loaded = *static_cast<const OpenImageIo*>(calls);
  if (std::string_view(loaded.version) != PRTKIT_VERSION) {
    throw_failed("OpenImageIO cannot be loaded", {.file = kFile,
                                                  .found = std::string("version ") + loaded.version,
                                                  .expected = PRTKIT_VERSION,
                                                  .advice = "Install prtkit anew."});
  }
  return loaded;
}

}  // namespace

const OpenImageIo& open_image_io() {
  static const OpenImageIo& loaded = load();
  return loaded;
}

}  // namespace prt::image
