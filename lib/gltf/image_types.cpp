#include "gltf/image_types.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>

namespace prt::gltf {

namespace {

bool starts_with(std::span<const std::byte> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

/// By the first bytes; empty: of none that is known here.
std::string type_of(std::span<const std::byte> bytes) {
  if (starts_with(bytes, "\x89PNG\r\n\x1a\n")) return "image/png";
  if (starts_with(bytes, "\xff\xd8\xff")) return "image/jpeg";
  if (starts_with(bytes, "\xabKTX 20\xbb")) return "image/ktx2";
  if (starts_with(bytes, "RIFF") && bytes.size() >= 12 && starts_with(bytes.subspan(8), "WEBP")) {
    return "image/webp";
  }
  if (bytes.size() >= 4 &&
      (starts_with(bytes.subspan(4), "ftypavif") || starts_with(bytes.subspan(4), "ftypavis"))) {
    return "image/avif";
  }
  return {};
}

/// Whether an image may be of that type, which glTF or an extension that the file uses names.
bool is_allowed(const Json& root, const std::string& type) {
  const Json* used = find(root, "extensionsUsed");
  const auto uses = [&](const char* name) {
    return used && std::find(used->begin(), used->end(), Json(name)) != used->end();
  };
  if (type == "image/webp") return uses("EXT_texture_webp");
  if (type == "image/avif") return uses("EXT_texture_avif");
  if (type == "image/ktx2") return uses("KHR_texture_basisu");
  return !type.empty();
}

}  // namespace

void name_image_types(State& state) {
  for (std::size_t i = 0; i < state.count("images"); ++i) {
    Json& image = state.root["images"][i];
    const Json& view = state.element("bufferViews", image["bufferView"].get<std::size_t>());
    const Bytes& buffer = state.buffers[view["buffer"].get<std::size_t>()];
    const std::string type = type_of(std::span(buffer).subspan(
        view.value("byteOffset", std::size_t{0}), view["byteLength"].get<std::size_t>()));
    if (!is_allowed(state.root, type)) {
      reject_at(state.where("image", i), "not an image that glTF knows", type, "PNG or JPEG");
    }
    image["mimeType"] = type;
  }
}

}  // namespace prt::gltf
