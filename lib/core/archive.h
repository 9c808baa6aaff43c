// The state of a computation in a checkpoint (core/checkpoint.h): one function lists its members,
// to write them and to read them back.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstring>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/checkpoint.h"

namespace prt {

class Archive {
 public:
  /// Takes members.
  Archive() = default;
  /// Gives them back, in the same order.
  explicit Archive(std::vector<std::byte> bytes) : bytes_(std::move(bytes)), is_reading_(true) {}

  /// Takes no members, only the room that they need.
  static Archive counter() {
    Archive archive;
    archive.is_counting_ = true;
    return archive;
  }
  void reserve(std::size_t byte_count) { bytes_.reserve(byte_count); }

  bool is_reading() const { return is_reading_; }
  std::size_t byte_count() const { return end_; }
  std::vector<std::byte> take_bytes() { return std::move(bytes_); }

  template <class T>
  void value(T& value) {
    copy(&value, 1);
  }
  /// Its size too.
  template <class T>
  void array(std::vector<T>& values) {
    std::size_t size = values.size();
    value(size);
    values.resize(size);
    copy(values.data(), size);
  }

 private:
  template <class T>
  void copy(T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t size = count * sizeof(T);
    if (size == 0) return;
    if (is_counting_) {
      end_ += size;
      return;
    }
    if (!is_reading_) bytes_.resize(end_ + size);
    assert(end_ + size <= bytes_.size());
    std::byte* const place = bytes_.data() + end_;
    is_reading_ ? std::memcpy(values, place, size) : std::memcpy(place, values, size);
    end_ += size;
  }

  std::vector<std::byte> bytes_;
  std::size_t end_ = 0;
  bool is_reading_ = false, is_counting_ = false;
};

/// Lists the members of a state.
using Members = std::function<void(Archive&)>;

/// False when nothing of that name is kept. The checkpoint may be nullptr, for none.
bool restore_state(const Checkpoint* checkpoint, Checkpoint::Name name, const Members& members);
void store_state(Checkpoint* checkpoint, Checkpoint::Name name, const Members& members);

}  // namespace prt
