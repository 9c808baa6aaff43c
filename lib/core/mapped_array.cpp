#include "core/mapped_array.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <string>

#include "core/error.h"
#include "core/parallel.h"

namespace prt {

namespace {

constexpr std::size_t kAlignment = 64;

// A fault on a mapped file brings 16 pages at most, as long as the system expects access at random;
// otherwise it may be 512. Together, threads bring some 16 MB between two looks.
constexpr long kFaultsPerLook = 256;

/// All mapped files of the process.
struct Registry {
  std::mutex mutex;
  std::map<void*, std::size_t> regions;
  std::atomic<bool> in_use = false;
  std::size_t untrimmed_bytes = 0;  ///< resident after the last trim: programs and libraries
};

Registry& registry() {
  static Registry instance;
  return instance;
}

/// Pages of files in the memory of this process.
std::size_t resident_file_bytes() {
  char text[128] = {};
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  unsigned long total = 0, resident = 0, shared = 0;
  if (size <= 0 || std::sscanf(text, "%lu %lu %lu", &total, &resident, &shared) != 3) return 0;
  return shared * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

long thread_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

void enter(void* data, std::size_t byte_count) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  if (all.regions.empty()) all.untrimmed_bytes = resident_file_bytes();
  all.regions[data] = byte_count;
  all.in_use = true;
}

void leave(void* data) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  all.regions.erase(data);
  all.in_use = !all.regions.empty();
}

}  // namespace

Mapping::Mapping(const std::filesystem::path& folder) {
  if (!folder.empty()) file_ = std::make_unique<NamelessFile>(folder);
}

Mapping::Mapping(Mapping&& other) noexcept { *this = std::move(other); }

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(data_, other.data_);
  std::swap(byte_count_, other.byte_count_);
  return *this;
}

Mapping::~Mapping() {
  if (!file_) {
    std::free(data_);
  } else if (data_) {
    leave(data_);
    munmap(data_, byte_count_);
  }
}

void Mapping::grow(std::size_t byte_count) {
  assert(byte_count > byte_count_);
  if (file_) return grow_in_file(byte_count);
  byte_count = (byte_count + kAlignment - 1) / kAlignment * kAlignment;
  void* larger = std::aligned_alloc(kAlignment, byte_count);
  if (!larger) throw std::bad_alloc();
  if (data_) std::memcpy(larger, data_, byte_count_);
  std::memset(static_cast<char*>(larger) + byte_count_, 0, byte_count - byte_count_);
  std::free(data_);
  data_ = larger;
  byte_count_ = byte_count;
}

void Mapping::grow_in_file(std::size_t byte_count) {
  file_->grow(byte_count);
  if (data_) leave(data_);  // from here on no other thread touches it
  void* larger =
      data_ ? mremap(data_, byte_count_, byte_count, MREMAP_MAYMOVE)
            : mmap(nullptr, byte_count, PROT_READ | PROT_WRITE, MAP_SHARED, file_->descriptor(), 0);
  if (larger == MAP_FAILED) {
    const std::string reason = std::strerror(errno);
    if (data_) enter(data_, byte_count_);
    throw_failed("cannot map a temporary file: " + reason, {.file = file_->folder().string()});
  }
  data_ = larger;
  byte_count_ = byte_count;
  madvise(data_, byte_count_, MADV_RANDOM);
  enter(data_, byte_count_);
}

void trim_mapped_arrays(std::size_t resident_bytes) {
  Registry& all = registry();
  if (!all.in_use.load(std::memory_order_relaxed)) return;
  thread_local long faults_at_look = 0;
  const long faults = thread_faults();
  if (faults - faults_at_look < kFaultsPerLook / thread_count()) return;
  faults_at_look = faults;
  const std::lock_guard lock(all.mutex);
  if (resident_file_bytes() <= all.untrimmed_bytes + resident_bytes) return;
  for (const auto& [data, byte_count] : all.regions) madvise(data, byte_count, MADV_DONTNEED);
  all.untrimmed_bytes = resident_file_bytes();
}

}  // namespace prt
