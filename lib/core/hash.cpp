#include "core/hash.h"

#include <fmt/format.h>
#define XXH_STATIC_LINKING_ONLY
#include <xxhash.h>

#include <fstream>
#include <vector>

#include "core/error.h"

namespace prt {

struct Hasher::State {
  XXH3_state_t xxh;
};

Hasher::Hasher() : state_(std::make_unique<State>()) { XXH3_128bits_reset(&state_->xxh); }
Hasher::~Hasher() = default;

void Hasher::add(const void* data, std::size_t byte_count) {
  if (byte_count > 0) XXH3_128bits_update(&state_->xxh, data, byte_count);
}

std::string Hasher::hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state_->xxh);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string hash_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_bad_input("cannot open the file", {.file = path.string()});
  Hasher hasher;
  std::vector<char> chunk(1 << 20);
  while (file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), file.gcount() > 0) {
    hasher.add(chunk.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw_failed("reading failed", {.file = path.string()});
  return hasher.hex();
}

}  // namespace prt
