// Arrays for data that grow with the model. Those of small models lie in memory. Those of large
// ones lie in nameless files (core/nameless_file.h) that are mapped: the system may move them out
// of memory, and trim_mapped_arrays keeps this process from holding more than a budget of them.
// What is given back stays in the file, most often in the system's cache of it, and comes again
// when it is read: values never depend on where an array lies.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "core/nameless_file.h"

namespace prt {

/// The bytes of a MappedArray, zeros at first.
class Mapping {
 public:
  /// In a nameless file in the folder, or, if its name is empty, in memory.
  explicit Mapping(const std::filesystem::path& folder = {});
  ~Mapping();
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&& other) noexcept;

  /// Moves to where there are so many bytes; they never become fewer. Throws Error (failed) when
  /// the disk has no room for them.
  void grow(std::size_t byte_count);
  void* data() const { return data_; }
  std::size_t byte_count() const { return byte_count_; }

 private:
  void grow_in_file(std::size_t byte_count);

  std::unique_ptr<NamelessFile> file_;  // null: in memory
  void* data_ = nullptr;
  std::size_t byte_count_ = 0;
};

template <class T>
class MappedArray {
  static_assert(std::is_trivially_destructible_v<T>);  // and moved byte by byte

 public:
  /// `count` elements of zero bytes, in memory or, with the name of a folder, in a file there.
  explicit MappedArray(std::size_t count = 0, const std::filesystem::path& folder = {})
      : mapping_(folder) {
    resize(count);
  }
  MappedArray(MappedArray&& other) noexcept { *this = std::move(other); }
  MappedArray& operator=(MappedArray&& other) noexcept {
    std::swap(mapping_, other.mapping_);
    std::swap(size_, other.size_);
    return *this;
  }

  /// New elements are zero bytes, unless push_back or resize had them before.
  void resize(std::size_t count) {
    if (count * sizeof(T) > mapping_.byte_count()) mapping_.grow(count * sizeof(T));
    size_ = count;
  }
  /// Room grows by a half at a time, by 64 MB at most.
  void push_back(const T& value) {
    if ((size_ + 1) * sizeof(T) > mapping_.byte_count()) {
      const std::size_t room = mapping_.byte_count() / 2;
      mapping_.grow((size_ + 1) * sizeof(T) +
                    std::clamp(room, std::size_t{1} << 12, std::size_t{1} << 26));
    }
    data()[size_++] = value;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return static_cast<T*>(mapping_.data()); }
  const T* data() const { return static_cast<const T*>(mapping_.data()); }
  T& operator[](std::size_t i) {
    assert(i < size_);
    return data()[i];
  }
  const T& operator[](std::size_t i) const {
    assert(i < size_);
    return data()[i];
  }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }

 private:
  Mapping mapping_;
  std::size_t size_ = 0;
};

/// Of mapped files, at most, in the memory of this process between two calls of trim_mapped_arrays,
/// beside what the threads read and write between them.
constexpr std::size_t kMappedResidentBytes = std::size_t{128} << 20;

/// Takes mapped arrays out of the memory of this process when it holds more of them than that.
/// Costs next to nothing otherwise: loops over mapped arrays call it every few thousand
/// elements. From any thread.
void trim_mapped_arrays(std::size_t resident_bytes = kMappedResidentBytes);

/// for (i = 0; i < count; ++i) body(i), trimming now and then.
template <class Body>
void for_each_trimmed(std::size_t count, const Body& body) {
  constexpr std::size_t kStep = 4096;
  for (std::size_t begin = 0; begin < count; begin += kStep) {
    for (std::size_t i = begin; i < std::min(count, begin + kStep); ++i) body(i);
    trim_mapped_arrays();
  }
}

}  // namespace prt
