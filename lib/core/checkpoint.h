// What a long computation has finished, kept in a file beside its output, so that a run that was
// killed is continued by the next one. Results are bytes under a name: those of a block that is
// done, or a state that later ones replace. A result takes the room of others that were
// replaced or released, never its own, so that a kill at any moment leaves the one or the other.
// Rooms side by side are one, and the last grows with the file: it is as large as the names in use
// and one more of each size that is replaced, or three times a state that grows little by little.
//
// It holds hashes of itself: results that were only half written, or damaged since, are not there
// for the reader. Keeping nothing is never an error: where the file cannot be written, or another
// process holds it, a warning tells so and the work goes on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/stopwatch.h"

namespace prt {

struct CheckpointOptions {
  std::filesystem::path path{};  ///< empty: nothing is kept
  double after_seconds = 10.0;   ///< of work, before which no file is made
};

class Checkpoint {
 public:
  struct Name {
    std::uint32_t stage, index;
    auto operator<=>(const Name&) const = default;
  };

  /// Opens what an earlier run has left that had the same `key`, all that the results depend on
  /// beside prtkit's version and the instruction set. A file of another key is overwritten when
  /// there is something to keep; one that is no checkpoint is left alone.
  Checkpoint(const CheckpointOptions& options, const std::string& key);
  ~Checkpoint();
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  /// Copies the result and returns true, or returns false if there is none of that size. Threads
  /// may call this and store.
  template <class T>
  bool restore(Name name, std::span<T> result) const {
    return restore_bytes(name, std::as_writable_bytes(result));
  }

  /// The same for a result of any size, which the vector takes.
  template <class T>
  bool restore(Name name, std::vector<T>& result) const {
    result.resize(byte_count(name) / sizeof(T));
    return restore(name, std::span(result));
  }

  /// Keeps the result if after_seconds have passed, or an earlier run is being continued. It
  /// replaces one of the same name.
  template <class T>
  void store(Name name, std::span<const T> result) {
    store_bytes(name, std::as_bytes(result));
  }

  /// Whether store() keeps anything now: states need not be put together before.
  bool is_due() const;

  /// Of all results of a stage.
  std::size_t byte_count(std::uint32_t stage) const;
  /// Gives the room of a stage to others: its results are not needed again.
  void release(std::uint32_t stage);

 private:
  struct Place {
    std::size_t offset, byte_count;  ///< of the result
    std::uint64_t number;            ///< the later was stored later
  };

  std::size_t byte_count(Name name) const;

  bool restore_bytes(Name name, std::span<std::byte> result) const;
  void store_bytes(Name name, std::span<const std::byte> result);
  void open_existing();
  void read_records();
  void add(Name name, const Place& place);
  void free_room(std::size_t offset, std::size_t size);
  bool take_room(std::size_t size, std::size_t& offset);
  void begin_file();
  void give_up(const char* why);

  const std::filesystem::path path_;
  const double after_seconds_;
  const std::string head_;  ///< what the file begins with: its kind and the hash of the key
  const Stopwatch watch_;
  mutable std::mutex mutex_;
  int descriptor_ = -1;
  bool given_up_, begun_ = false;  ///< begun_: the file has head_
  std::size_t end_ = 0;            ///< of the last record
  std::uint64_t last_number_ = 0;
  std::map<Name, Place> places_;
  /// Where records are no longer needed: sizes of rooms by their offsets, none beside another.
  std::map<std::size_t, std::size_t> room_;
};

/// Removes the file if it is a checkpoint: when the output is written.
void remove_checkpoint(const std::filesystem::path& path);

}  // namespace prt
