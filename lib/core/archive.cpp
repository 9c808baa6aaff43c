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
  Archive counter = Archive::counter(), archive;
  members(counter);
  // Up to an eighth more, so that states whose sizes vary a little take each other's room.
  const std::size_t step = std::max<std::size_t>(std::bit_ceil(counter.byte_count()) / 16, 1),
                    room = (counter.byte_count() + step - 1) / step * step;
  archive.reserve(room);  // large states are not copied while they grow
  members(archive);
  std::vector<std::byte> bytes = archive.take_bytes();
  bytes.resize(room);
  checkpoint->store(name, std::span<const std::byte>(bytes));
}

}  // namespace prt
