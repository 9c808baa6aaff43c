// glTF of any bytes: loading, looking at everything, import, and saving, which must load again.
#include <cstdio>

#include "core/error.h"
#include "core/log.h"
#include "gltf/document.h"
#include "gltf/repair_geometry.h"

namespace {

constexpr prt::gltf::Limits kLimits{.max_file_bytes = 1 << 20,
                                    .max_image_pixels = 1 << 16,
                                    .max_node_depth = 32,
                                    .max_element_count = 1 << 16};

template <class Work>
void attempt(const Work& work) {
  try {
    work();
  } catch (const prt::Error&) {
  }
}

prt::gltf::Document parse(std::span<const std::byte> bytes) {
  return prt::gltf::Document::parse(bytes, "/nonexistent/fuzz.glb", kLimits);
}

// Only what the limits forbid is no longer accepted once it is saved.
void check_saved(const prt::gltf::Document& document) {
  try {
    parse(document.glb_bytes());
  } catch (const prt::Error& error) {
    if (error.details().found.find("bytes") != std::string::npos) return;
    std::fprintf(stderr, "refused once it is saved: %s\n", error.what());
    __builtin_trap();
  }
}

void use(std::span<const std::byte> bytes) {
  prt::gltf::Document document = parse(bytes);
  attempt([&] { document.scene(); });
  attempt([&] { document.precomputed_transfer(); });
  check_saved(document);
  prt::gltf::Document bare = parse(bytes);
  bare.remove_precomputed_transfer();
  check_saved(bare);
  attempt([&] {
    prt::gltf::repair_geometry(*document.state(), {});
    document.scene();  // what import accepts can be baked
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  prt::log::set_level(prt::log::Level::error);
  attempt([&] { use(std::as_bytes(std::span(data, size))); });
  return 0;
}
