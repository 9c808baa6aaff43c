// Content hashes (XXH3, 128 bits): of the mesh that a transfer belongs to, and of the files that
// reports name. Not for security.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace prt {

class Hasher {
 public:
  Hasher();
  ~Hasher();
  void add(const void* data, std::size_t byte_count);
  template <class T>
  void add(std::span<const T> values) {
    add(values.data(), values.size_bytes());
  }
  /// 32 lower-case hexadecimal digits of all that was added.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Hash of a file's bytes. Throws Error when it cannot be read.
std::string hash_file(const std::filesystem::path& path);

}  // namespace prt
