#include "core/archive.h"

#include <algorithm>
#include <bit>

namespace prt {

bool restore_state(const Checkpoint* checkpoint, Checkpoint::Name name, const Members& members) {
  std::vector<std::byte> bytes;
  if (checkpoint == nullptr || !checkpoint->restore(name, bytes)) return false;
  Archive archive(std::move(bytes));
  members(archive);
  return true;
}

void store_state(Checkpoint* checkpoint, Checkpoint::Name name, const Members& members) {
  if (checkpoint == nullptr || !checkpoint->is_due()) return;
  Archive archive;
  members(archive);
  // Up to an eighth more, so that states whose sizes vary a little take each other's room.
  std::vector<std::byte> bytes = archive.take_bytes();
  const std::size_t step = std::max<std::size_t>(std::bit_ceil(bytes.size()) / 16, 1);
  bytes.resize((bytes.size() + step - 1) / step * step);
  checkpoint->store(name, std::span<const std::byte>(bytes));
}

}  // namespace prt
