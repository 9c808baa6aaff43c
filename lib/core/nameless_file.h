// A file without a name: room on disk for what a computation does not keep in memory. It goes with
// its owner, however the process ends. On tmpfs files are memory.
#pragma once

#include <cstddef>
#include <filesystem>

namespace prt {

class NamelessFile {
 public:
  /// An empty file in `folder`. Throws Error (failed) with the system's reason.
  explicit NamelessFile(std::filesystem::path folder);
  ~NamelessFile();
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  /// Makes the file byte_count long, zeros from its old end on, and takes all the room for them
  /// now: where the file system can promise it, later writes, also through a mapping, do not fail
  /// for want of it. Throws Error (failed) when there is no such room.
  void grow(std::size_t byte_count);

  int descriptor() const { return descriptor_; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
  std::size_t byte_count_ = 0;
};

}  // namespace prt
