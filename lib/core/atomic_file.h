// Output that is either complete or absent: written to a temporary file in the same folder, synced,
// renamed. An exception, an exit, SIGINT, SIGTERM, SIGHUP, SIGQUIT or SIGPIPE leaves no temporary
// file behind and an earlier output untouched. A link to a regular file stays: what it names is
// replaced.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace prt {

class AtomicFile {
 public:
  /// Creates the temporary file beside `path`. Throws Error (failed) when the folder is missing or
  /// not writable, or when `no_clobber` is set and `path` exists.
  explicit AtomicFile(std::filesystem::path path, bool no_clobber = false);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write, for writers that want a path (it keeps the extension of the final one).
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Writes through our own descriptor. Throws Error (failed) with the system's reason.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Syncs and renames. Throws Error (failed) when the disk is full.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  int slot_ = -1;  // in the table that the signal handler removes
  bool no_clobber_;
};

/// Throws Error (failed) when `path` cannot become an output: its folder is missing or not
/// writable, or it exists and no_clobber is set or it is not a regular file (a folder, a device, a
/// pipe, a link to one of these or to nothing). Tools ask before the work, not after.
void check_output(const std::filesystem::path& path, bool no_clobber);

/// The same of a folder, which is made when it is missing; it may be written with a slash at its
/// end. Throws Error (failed) when `path` is neither a folder nor can become one.
void check_output_folder(const std::filesystem::path& path);

}  // namespace prt
