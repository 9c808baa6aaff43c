#include "core/checkpoint.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "core/cpu.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/mapped_array.h"

namespace prt {

namespace {

constexpr std::string_view kKind = "prtkit unfinished work, version ", kVersion = "4\n";

/// Before each result; the hash of both, kHashSize characters, comes after it.
struct RecordHead {
  std::uint32_t stage, index;
  std::uint64_t byte_count, number;
};
constexpr std::size_t kHashSize = 32;
constexpr std::uint32_t kNoStage = 0xffffffff;        // of room that is left
constexpr std::size_t kPiece = std::size_t{8} << 20;  // what is moved of a mapped array at a time

/// Of the record of a result.
constexpr std::size_t record_size(std::size_t byte_count) {
  return sizeof(RecordHead) + byte_count + kHashSize;
}

std::string make_head(const std::string& key) {
  Hasher hasher;
  for (const std::string_view part :
       {std::string_view(PRTKIT_VERSION "\n"), std::string_view(simd_level_name(simd_level())),
        std::string_view(key)}) {
    hasher.add(part.data(), part.size());
  }
  return std::string(kKind) + std::string(kVersion) + hasher.hex();
}

bool read_all(int descriptor, void* bytes, std::size_t count, std::size_t offset) {
  auto* to = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t done = pread(descriptor, to, std::min(count, kPiece), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    trim_mapped_arrays();
    to += done;
    offset += static_cast<std::size_t>(done);
    count -= static_cast<std::size_t>(done);
  }
  return true;
}

bool write_all(int descriptor, const void* bytes, std::size_t count, std::size_t offset) {
  const auto* from = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t done =
        pwrite(descriptor, from, std::min(count, kPiece), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return false;
    trim_mapped_arrays();
    from += done;
    offset += static_cast<std::size_t>(done);
    count -= static_cast<std::size_t>(done);
  }
  return true;
}

/// Whether the hash that follows the record at `offset` is its own.
bool is_whole(int descriptor, const RecordHead& head, std::size_t offset) {
  Hasher hasher;
  hasher.add(&head, sizeof head);
  std::vector<char> chunk(std::min<std::size_t>(head.byte_count, 1 << 20));
  offset += sizeof head;
  for (std::size_t left = head.byte_count; left > 0;) {
    const std::size_t count = std::min(left, chunk.size());
    if (!read_all(descriptor, chunk.data(), count, offset)) return false;
    hasher.add(chunk.data(), count);
    offset += count;
    left -= count;
  }
  std::array<char, kHashSize> hash{};
  return read_all(descriptor, hash.data(), kHashSize, offset) &&
         hasher.hex() == std::string_view(hash.data(), kHashSize);
}

}  // namespace

Checkpoint::Checkpoint(const CheckpointOptions& options, const std::string& key)
    : path_(options.path),
      after_seconds_(options.after_seconds),
      head_(make_head(key)),
      given_up_(path_.empty()) {
  if (!given_up_) open_existing();
}

Checkpoint::~Checkpoint() {
  if (descriptor_ >= 0) close(descriptor_);
}

void Checkpoint::open_existing() {
  descriptor_ = open(path_.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor_ < 0) {
    if (errno != ENOENT) give_up(std::strerror(errno));
    return;
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) return give_up("used by another process");
  std::string head(head_.size(), '\0');
  const bool read = read_all(descriptor_, head.data(), head.size(), 0);
  struct stat status {};
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode) ||
      (status.st_size > 0 && !head.starts_with(kKind))) {
    return give_up("exists and is something else");
  }
  begun_ = read && head == head_;
  if (begun_) read_records();
}

// A record whose hash is wrong was being overwritten when the process died: its room is free.
void Checkpoint::read_records() {
  struct stat status {};
  fstat(descriptor_, &status);
  const auto size = static_cast<std::size_t>(status.st_size);
  end_ = head_.size();
  RecordHead head{};
  for (std::size_t offset = end_; size - offset >= sizeof head + kHashSize;) {
    if (!read_all(descriptor_, &head, sizeof head, offset)) return;
    if (head.byte_count > size - offset - sizeof head - kHashSize) return;
    const Place place{offset + sizeof head, head.byte_count, head.number};
    if (is_whole(descriptor_, head, offset)) {
      add({head.stage, head.index}, place);
    } else {
      free_room(offset, record_size(head.byte_count));
    }
    end_ = offset += record_size(head.byte_count);
  }
}

void Checkpoint::add(Name name, const Place& place) {
  last_number_ = std::max(last_number_, place.number);
  const auto [known, is_new] = places_.try_emplace(name, place);
  if (is_new) return;
  const bool is_later = place.number > known->second.number;
  const Place older = is_later ? std::exchange(known->second, place) : place;
  free_room(older.offset - sizeof(RecordHead), record_size(older.byte_count));
}

void Checkpoint::free_room(std::size_t offset, std::size_t size) {
  auto next = room_.lower_bound(offset);
  if (next != room_.end() && next->first == offset + size) {
    size += next->second;
    next = room_.erase(next);
  }
  if (next != room_.begin() && std::prev(next)->first + std::prev(next)->second == offset) {
    std::prev(next)->second += size;
  } else {
    room_.emplace(offset, size);
  }
}

/// The smallest room that has the size, or one at the end of the file, which becomes longer. False
/// when the file cannot be written. What is left of a room is a record too, which is not whole; it
/// counts only once the head of that before it is written.
bool Checkpoint::take_room(std::size_t size, std::size_t& offset) {
  auto best = room_.end();
  for (auto room = room_.begin(); room != room_.end(); ++room) {
    const bool fits = room->second == size || room->second >= size + record_size(0);
    if (fits && (best == room_.end() || room->second < best->second)) best = room;
  }
  if (best == room_.end() && !room_.empty()) {
    const auto last = std::prev(room_.end());
    if (last->first + last->second == end_ && last->second < size) best = last;
  }
  offset = best != room_.end() ? best->first : end_;
  const std::size_t found = best != room_.end() ? best->second : 0;
  if (best != room_.end()) room_.erase(best);
  if (found <= size) return true;
  const RecordHead rest{kNoStage, 0, found - size - record_size(0), 0};
  room_.emplace(offset + size, found - size);
  return write_all(descriptor_, &rest, sizeof rest, offset + size);
}

std::size_t Checkpoint::byte_count(Name name) const {
  const std::lock_guard lock(mutex_);
  const auto found = places_.find(name);
  return found != places_.end() ? found->second.byte_count : 0;
}

std::size_t Checkpoint::byte_count(std::uint32_t stage) const {
  const std::lock_guard lock(mutex_);
  std::size_t sum = 0;
  for (auto at = places_.lower_bound({stage, 0}); at != places_.end() && at->first.stage == stage;
       ++at) {
    sum += at->second.byte_count;
  }
  return sum;
}

void Checkpoint::release(std::uint32_t stage) {
  const std::lock_guard lock(mutex_);
  for (auto at = places_.lower_bound({stage, 0}); at != places_.end() && at->first.stage == stage;
       at = places_.erase(at)) {
    free_room(at->second.offset - sizeof(RecordHead), record_size(at->second.byte_count));
  }
}

bool Checkpoint::restore_bytes(Name name, std::span<std::byte> result) const {
  const std::lock_guard lock(mutex_);
  const auto found = places_.find(name);
  return found != places_.end() && found->second.byte_count == result.size() &&
         read_all(descriptor_, result.data(), result.size(), found->second.offset);
}

bool Checkpoint::is_due() const {
  const std::lock_guard lock(mutex_);
  return !given_up_ && (begun_ || watch_.seconds() >= after_seconds_);
}

void Checkpoint::store_bytes(Name name, std::span<const std::byte> result) {
  if (!is_due()) return;
  const std::lock_guard lock(mutex_);
  if (given_up_) return;
  if (!begun_) begin_file();
  if (given_up_) return;
  const RecordHead head{name.stage, name.index, result.size(), last_number_ + 1};
  Hasher hasher;
  hasher.add(&head, sizeof head);
  for (std::size_t at = 0; at < result.size(); at += kPiece) {
    hasher.add(result.subspan(at, std::min(kPiece, result.size() - at)));
    trim_mapped_arrays();
  }
  std::size_t start = 0;
  const bool has_room = take_room(record_size(result.size()), start);
  const std::size_t offset = start + sizeof head;
  if (!has_room || !write_all(descriptor_, &head, sizeof head, start) ||
      !write_all(descriptor_, result.data(), result.size(), offset) ||
      !write_all(descriptor_, hasher.hex().data(), kHashSize, offset + result.size())) {
    give_up(std::strerror(errno));
    unlink(path_.c_str());  // leaves room for the output
    close(std::exchange(descriptor_, -1));
    return;
  }
  add(name, {offset, result.size(), head.number});
  end_ = std::max(end_, offset + result.size() + kHashSize);
}

void Checkpoint::begin_file() {
  std::signal(SIGXFSZ, SIG_IGN);  // a size limit then shows as EFBIG, and the work goes on
  if (descriptor_ < 0) {
    descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      return give_up(std::strerror(errno));
    }
  }
  if (ftruncate(descriptor_, 0) != 0 || !write_all(descriptor_, head_.data(), head_.size(), 0)) {
    return give_up(std::strerror(errno));
  }
  begun_ = true;
  end_ = head_.size();
}

void Checkpoint::give_up(const char* why) {
  log::warning("{}: {}: this run cannot be continued if it is interrupted", path_.string(), why);
  given_up_ = true;
  places_.clear();
  room_.clear();
}

void remove_checkpoint(const std::filesystem::path& path) {
  std::string kind(kKind.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(kind.data(), static_cast<std::streamsize>(kind.size()));
  if (file && kind == kKind) unlink(path.c_str());
}

}  // namespace prt
