#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include "core/error.h"
#include "core/file.h"

namespace prt {

namespace {

// Paths that a signal handler has to unlink: fixed storage, since a handler may not allocate.
constexpr std::size_t kSlotCount = 16;
constexpr std::size_t kPathLimit = 4096;
struct Slot {
  std::atomic<bool> used{false};
  std::atomic<bool> ready{false};
  std::array<char, kPathLimit> path{};
};
std::array<Slot, kSlotCount> slots;

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE};

/// Files that exist but have no slot yet.
std::atomic<int> unregistered{0};

/// While it lives this thread takes no signal, and the handler on another one waits.
class RegistrationGuard {
 public:
  RegistrationGuard() {
    sigset_t blocked;
    sigemptyset(&blocked);
    for (const int signal : kSignals) sigaddset(&blocked, signal);
    pthread_sigmask(SIG_BLOCK, &blocked, &earlier_);
    ++unregistered;
  }
  ~RegistrationGuard() {
    --unregistered;
    pthread_sigmask(SIG_SETMASK, &earlier_, nullptr);
  }
  RegistrationGuard(const RegistrationGuard&) = delete;
  RegistrationGuard& operator=(const RegistrationGuard&) = delete;

 private:
  sigset_t earlier_{};
};

void remove_all() {
  for (Slot& slot : slots) {
    if (slot.ready.load()) unlink(slot.path.data());
  }
}

void on_signal(int signal) {
  while (unregistered.load() > 0) {
  }
  remove_all();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void install_handlers() {
  static std::once_flag once;
  std::call_once(once, [] {
    std::atexit(remove_all);
    std::signal(SIGXFSZ, SIG_IGN);  // a size limit then shows as EFBIG from write, with our message
    for (const int signal : kSignals) {
      struct sigaction current {};
      if (sigaction(signal, nullptr, &current) == 0 && current.sa_handler == SIG_DFL) {
        struct sigaction action {};
        action.sa_handler = on_signal;
        sigaction(signal, &action, nullptr);
      }
    }
  });
}

int acquire_slot(const std::string& path) {
  if (path.size() >= kPathLimit) return -1;
  for (std::size_t i = 0; i < kSlotCount; ++i) {
    bool expected = false;
    if (slots[i].used.compare_exchange_strong(expected, true)) {
      std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
      slots[i].ready = true;
      return static_cast<int>(i);
    }
  }
  return -1;
}

void release_slot(int slot) {
  if (slot < 0) return;
  slots[static_cast<std::size_t>(slot)].ready = false;
  slots[static_cast<std::size_t>(slot)].used = false;
}

/// What a link names; other paths as they are.
std::filesystem::path resolved(const std::filesystem::path& path) {
  std::error_code code;
  return std::filesystem::is_symlink(path, code) ? std::filesystem::canonical(path, code) : path;
}

[[noreturn]] void throw_system(const std::string& what, const std::filesystem::path& path) {
  throw_failed(what + ": " + std::strerror(errno), {.file = path.string()});
}

/// Whether a file or folder can be made where `path` says.
void check_place(const std::filesystem::path& path) {
  const std::filesystem::path folder = folder_of(resolved(path));
  struct stat status {};
  int reason = 0;
  if (stat(folder.c_str(), &status) != 0) {
    reason = errno;
  } else if (!S_ISDIR(status.st_mode)) {
    reason = ENOTDIR;
  } else if (access(folder.c_str(), W_OK | X_OK) != 0) {
    reason = errno;
  }
  if (reason == 0) return;
  throw_failed(
      fmt::format("nothing can be written in {}: {}", folder.string(), std::strerror(reason)),
      {.file = path.string(),
       .advice = reason == ENOENT ? "Create " + folder.string() + " first." : ""});
}

/// So that a new name in it lasts. Folders of some file systems cannot be synced: as good as none.
void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path, bool no_clobber)
    : path_(std::move(path)), no_clobber_(no_clobber) {
  check_output(path_, no_clobber_);
  path_ = resolved(path_);
  install_handlers();
  const std::string extension = path_.extension().string();
  const std::string name = fmt::format(".{}.XXXXXX{}", path_.stem().string(), extension);
  std::string pattern = (path_.parent_path() / name).string();
  const RegistrationGuard guard;
  descriptor_ = mkostemps(pattern.data(), static_cast<int>(extension.size()), O_CLOEXEC);
  if (descriptor_ < 0) throw_system("cannot create the output", path_);
  temporary_ = pattern;
  slot_ = acquire_slot(pattern);
  const mode_t mask = umask(0);
  umask(mask);
  fchmod(descriptor_, 0666 & ~mask);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
  release_slot(slot_);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      throw_system("writing failed", path_);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void AtomicFile::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void AtomicFile::commit() {
  // A library may have replaced the file behind our descriptor: sync what the path names now.
  const int current = open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (current < 0) throw_system("the temporary output is gone", path_);
  const bool synced = fsync(current) == 0;
  close(current);
  if (!synced) throw_system("writing failed", path_);
  if (no_clobber_) {
    if (link(temporary_.c_str(), path_.c_str()) != 0) throw_system("not overwriting", path_);
  } else {
    if (rename(temporary_.c_str(), path_.c_str()) != 0) throw_system("cannot rename", path_);
    temporary_.clear();
  }
  sync_folder(folder_of(path_));  // the destructor removes a temporary name that is left
}

void check_output(const std::filesystem::path& path, bool no_clobber) {
  struct stat status {};
  if (no_clobber && lstat(path.c_str(), &status) == 0) {
    throw_failed("exists, and --no-clobber is set", {.file = path.string()});
  }
  if (lstat(path.c_str(), &status) == 0 &&
      (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode))) {
    throw_failed("exists and is not a regular file",
                 {.file = path.string(), .advice = "Give another name."});
  }
  check_place(path);
}

void check_output_folder(const std::filesystem::path& path) {
  // Of "plots/" the parent is "plots", which is not there yet.
  const std::filesystem::path name = path.has_filename() ? path : path.parent_path();
  if (!std::filesystem::exists(name)) return check_output(name, false);
  if (!std::filesystem::is_directory(name)) {
    throw_failed("exists and is no folder",
                 {.file = path.string(), .advice = "Name a folder, or one that is to be made."});
  }
}

}  // namespace prt
