#include "gltf/container.h"

#include <fmt/format.h>

#include <cstring>
#include <limits>

#include "core/error.h"
#include "core/file.h"
#include "core/reference.h"
#include "core/report.h"

namespace prt::gltf {

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr std::size_t kMaxJsonDepth = 128;
constexpr std::size_t kMaxKeys = 4096;

std::uint32_t load_u32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value;
  std::memcpy(&value, &bytes[offset], sizeof(value));
  return value;
}

struct Chunks {
  std::span<const std::byte> json, bin;
  bool has_bin = false;
};

Chunks split_glb(std::span<const std::byte> bytes, const std::string& file) {
  const auto reject = [&](const std::string& what, const std::string& found = {},
                          const std::string& expected = {}) {
    throw_bad_input(what, {.file = file, .element = "GLB", .found = found, .expected = expected});
  };
  if (bytes.size() < kHeaderBytes) reject("truncated header");
  if (load_u32(bytes, 4) != 2) reject("bad version", std::to_string(load_u32(bytes, 4)), "2");
  const std::size_t length = load_u32(bytes, 8);
  if (length > bytes.size() || length < kHeaderBytes) {
    reject("the file is truncated", fmt::format("{} bytes", bytes.size()),
           fmt::format("{} bytes, as the header says", length));
  }
  bytes = bytes.subspan(0, length);
  Chunks chunks;
  for (std::size_t offset = kHeaderBytes; offset < length;) {
    if (length - offset < kChunkHeaderBytes) reject("truncated chunk header");
    const std::size_t size = load_u32(bytes, offset);
    const std::uint32_t type = load_u32(bytes, offset + 4);
    if (size > length - offset - kChunkHeaderBytes) {
      reject("a chunk runs past the end", fmt::format("{} bytes", size),
             fmt::format("at most {}", length - offset - kChunkHeaderBytes));
    }
    const auto content = bytes.subspan(offset + kChunkHeaderBytes, size);
    const bool first = offset == kHeaderBytes;
    if (first != (type == kJsonChunk)) reject("the first chunk, and no other, must be JSON");
    if (first) chunks.json = content;
    if (type == kBinChunk && !chunks.has_bin) {
      chunks.bin = content;
      chunks.has_bin = true;
    }
    offset += kChunkHeaderBytes + size;
  }
  if (chunks.json.empty()) reject("no JSON chunk");
  return chunks;
}

// Our JSON library parses any depth, but writing and destroying recurse; and it looks for a key of
// an object in one member after the other.
void check_structure(std::string_view text, const std::string& file) {
  const auto reject = [&](const char* what, std::size_t most) {
    throw_bad_input(what, {.file = file, .expected = fmt::format("at most {}", most)});
  };
  std::vector<std::size_t> key_counts;  // of the objects, and arrays, around this place
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      key_counts.push_back(0);
      if (key_counts.size() > kMaxJsonDepth) reject("JSON nested too deeply", kMaxJsonDepth);
    } else if (c == ':' && !key_counts.empty()) {
      if (++key_counts.back() > kMaxKeys) reject("too many keys in a JSON object", kMaxKeys);
    } else if ((c == '}' || c == ']') && !key_counts.empty()) {
      key_counts.pop_back();
    }
  }
}

Json parse_json(std::string_view text, const std::string& file) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || text[first] != '{') {
    throw_bad_input("not a glTF file", {.file = file});
  }
  check_structure(text, file);
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw_bad_input(fmt::format("not a glTF file: {}", error.what()), {.file = file});
  }
}

// Fetches what URIs name, and keeps count of the bytes.
class Fetcher {
 public:
  explicit Fetcher(const State& state) : state_(state) {}

  Bytes fetch(std::string_view uri, const Where& where) {
    if (uri.starts_with("data:")) {
      if (uri.size() > left_) reject(where);
      Bytes bytes = decode_data_uri(uri, where);
      left_ -= bytes.size();
      return bytes;
    }
    const auto path = resolve_reference(state_.file, uri, Escapes::percent);
    Bytes bytes = read_file(path, left_);
    left_ -= bytes.size();
    return bytes;
  }

 private:
  [[noreturn]] void reject(const Where& where) const {
    reject_at(where, "buffers and images are too large", {},
              fmt::format("{} bytes in all", state_.limits.max_file_bytes));
  }

  const State& state_;
  std::size_t left_ = state_.limits.max_file_bytes;
};

void load_buffers(State& state, const Chunks& chunks, Fetcher& fetcher) {
  if (!state.root.contains("buffers")) return;
  Json& buffers = state.root["buffers"];
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const Where where = state.where("buffer", i);
    const std::size_t length = required_count(buffers[i], "byteLength", where);
    Bytes bytes;
    if (buffers[i].contains("uri")) {
      bytes = fetcher.fetch(optional_string(buffers[i], "uri", where), where);
      buffers[i].erase("uri");
    } else if (i == 0 && chunks.has_bin) {
      bytes.assign(chunks.bin.begin(), chunks.bin.end());
    } else {
      throw_bad_input("no URI and no binary chunk: compressed data is not supported",
                      {.file = state.file, .element = where.element});
    }
    if (bytes.size() < length) {
      throw_bad_input("the buffer is truncated", {.file = state.file,
                                                  .element = where.element,
                                                  .found = fmt::format("{} bytes", bytes.size()),
                                                  .expected = fmt::format("{}", length)});
    }
    bytes.resize(length);
    state.buffers.push_back(std::move(bytes));
  }
}

void load_images(State& state, Fetcher& fetcher) {
  if (!state.root.contains("images")) return;
  for (std::size_t i = 0; i < state.root["images"].size(); ++i) {
    const Where where = state.where("image", i);
    const Json& image = state.root["images"][i];
    if (!image.contains("uri")) continue;
    Bytes bytes = fetcher.fetch(optional_string(image, "uri", where), where);
    Json& views = make_array(state.root, "bufferViews");
    make_array(state.root, "buffers").push_back({{"byteLength", bytes.size()}});
    views.push_back({{"buffer", state.buffers.size()}, {"byteLength", bytes.size()}});
    state.buffers.push_back(std::move(bytes));
    Json& target = state.root["images"][i];
    target.erase("uri");
    target["bufferView"] = views.size() - 1;
  }
}

void append_u32(Bytes& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<std::byte>((value >> shift) & 0xff));
  }
}

// Buffers one after the other, each at a multiple of 4; views move along.
Bytes merge_buffers(const State& state, Json& root) {
  Bytes merged;
  std::vector<std::size_t> offsets;
  for (const Bytes& buffer : state.buffers) {
    merged.resize((merged.size() + 3) / 4 * 4);
    offsets.push_back(merged.size());
    merged.insert(merged.end(), buffer.begin(), buffer.end());
  }
  if (offsets.empty()) return merged;
  if (root.contains("bufferViews")) {
    for (Json& view : root["bufferViews"]) {
      const std::size_t offset = offsets[view["buffer"].get<std::size_t>()];
      view["byteOffset"] = offset + view.value("byteOffset", std::size_t{0});
      view["buffer"] = 0;
    }
  }
  Json first = root["buffers"][0];
  first["byteLength"] = merged.size();
  root["buffers"] = Json::array({first});
  return merged;
}

}  // namespace

void load_container(State& state, std::span<const std::byte> bytes) {
  Chunks chunks{.json = bytes, .bin = {}};
  if (bytes.size() >= 4 && load_u32(bytes, 0) == kGlbMagic) chunks = split_glb(bytes, state.file);
  state.root = parse_json({reinterpret_cast<const char*>(chunks.json.data()), chunks.json.size()},
                          state.file);
  if (!state.root.is_object()) throw_bad_input("not a glTF file", {.file = state.file});
  reserve_keys(state.root);
  for (const char* array : {"buffers", "bufferViews", "images"}) {
    const Json* found = find(state.root, array);
    if (found && !found->is_array()) {
      throw_bad_input("not an array", {.file = state.file, .element = array});
    }
  }
  Fetcher fetcher(state);
  load_buffers(state, chunks, fetcher);
  load_images(state, fetcher);
}

Bytes make_glb(const State& state) {
  Json root = state.root;
  reserve_keys(root);
  make_object(root, "asset")["generator"] = "prtkit " PRTKIT_VERSION;
  root["asset"]["version"] = "2.0";
  Bytes bin = merge_buffers(state, root);
  std::string text = json_text(root);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  bin.resize((bin.size() + 3) / 4 * 4);
  const std::size_t total = kHeaderBytes + kChunkHeaderBytes + text.size() +
                            (bin.empty() ? 0 : kChunkHeaderBytes + bin.size());
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw_failed("a .glb file cannot be larger than 4 GiB",
                 {.found = fmt::format("{} bytes", total)});
  }
  Bytes glb;
  glb.reserve(total);
  append_u32(glb, kGlbMagic);
  append_u32(glb, 2);
  append_u32(glb, total);
  append_u32(glb, text.size());
  append_u32(glb, kJsonChunk);
  const auto text_bytes = std::as_bytes(std::span(text));
  glb.insert(glb.end(), text_bytes.begin(), text_bytes.end());
  if (bin.empty()) return glb;
  append_u32(glb, bin.size());
  append_u32(glb, kBinChunk);
  glb.insert(glb.end(), bin.begin(), bin.end());
  return glb;
}

}  // namespace prt::gltf
