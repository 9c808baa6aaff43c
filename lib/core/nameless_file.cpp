#include "core/nameless_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
#include <utility>

#include "core/error.h"

namespace prt {

namespace {

int open_nameless(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) return descriptor;
  // Some file systems have no nameless files.
  std::string pattern = (folder / ".prtkit.XXXXXX").string();
  const int named = mkostemp(pattern.data(), O_CLOEXEC);
  if (named < 0) {
    throw_failed(std::string("cannot create a temporary file: ") + std::strerror(errno),
                 {.file = folder.string()});
  }
  unlink(pattern.c_str());
  return named;
}

}  // namespace

NamelessFile::NamelessFile(std::filesystem::path folder)
    : folder_(std::move(folder)), descriptor_(open_nameless(folder_)) {}

NamelessFile::~NamelessFile() { close(descriptor_); }

void NamelessFile::grow(std::size_t byte_count) {
  if (byte_count <= byte_count_) return;
  std::signal(SIGXFSZ, SIG_IGN);  // a size limit then shows as EFBIG
  int error = EINTR;
  while (error == EINTR) {
    error = posix_fallocate(descriptor_, static_cast<off_t>(byte_count_),
                            static_cast<off_t>(byte_count - byte_count_));
  }
  if (error == 0) {
    byte_count_ = byte_count;
    return;
  }
  throw_failed(
      "no room for temporary data",
      {.file = folder_.string(),
       .found = std::strerror(error),
       .expected = fmt::format("{} MB of space for the time of the work", (byte_count >> 20) + 1)});
}

}  // namespace prt
