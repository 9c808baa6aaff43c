#include "signal/npz.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>

#include "core/atomic_file.h"

namespace prt::signal {

namespace {

// Of PKWARE's APPNOTE 6.3, 4.3.7 to 4.3.16.
constexpr std::uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50,
                        kZip64End = 0x06064b50, kZip64Locator = 0x07064b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 45;           // the first with ZIP64
constexpr std::uint16_t kDate = (1 << 5) | 1;    // 1 January 1980
constexpr std::uint32_t kInZip64 = 0xffffffffu;  // where the ZIP64 field has the number
constexpr std::uint16_t kZip64Field = 1;
constexpr std::size_t kZip64EndSize = 56;

/// Little-endian numbers one after the other.
class Record {
 public:
  template <class T>
  Record& put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
    return *this;
  }
  Record& put_text(const std::string& text) {
    bytes_ += text;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

struct Entry {
  std::string name;
  std::uint32_t crc = 0;
  std::uint64_t size = 0, offset = 0;
};

std::uint32_t checksum(const std::string& header, std::span<const std::byte> data) {
  uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(header.data()), header.size());
  // Of a null pointer, which empty data may have, zlib begins anew.
  if (!data.empty()) {
    crc = crc32_z(crc, reinterpret_cast<const Bytef*>(data.data()), data.size());
  }
  return static_cast<std::uint32_t>(crc);
}

/// What local and central header share: version to extra length.
void put_common(Record& record, const Entry& entry, std::uint16_t extra_size) {
  record.put(kVersion).put(std::uint16_t{0}).put(std::uint16_t{0});  // no flags, stored
  record.put(std::uint16_t{0}).put(kDate).put(entry.crc).put(kInZip64).put(kInZip64);
  record.put(static_cast<std::uint16_t>(entry.name.size())).put(extra_size);
}

std::string local_header(const Entry& entry) {
  Record record;
  record.put(kLocalHeader);
  put_common(record, entry, 20);
  record.put_text(entry.name);
  record.put(kZip64Field).put(std::uint16_t{16}).put(entry.size).put(entry.size);
  return record.bytes();
}

std::string central_header(const Entry& entry) {
  Record record;
  record.put(kCentralHeader).put(kVersion);
  put_common(record, entry, 28);
  record.put(std::uint16_t{0}).put(std::uint16_t{0}).put(std::uint16_t{0});  // comment, disk, kind
  record.put(std::uint32_t{0}).put(kInZip64).put_text(entry.name);
  record.put(kZip64Field).put(std::uint16_t{24}).put(entry.size).put(entry.size).put(entry.offset);
  return record.bytes();
}

std::string end_records(std::uint64_t entry_count, std::uint64_t size, std::uint64_t offset) {
  constexpr std::uint32_t kDisk = 0;
  Record record;
  record.put(kZip64End).put(std::uint64_t{kZip64EndSize - 12}).put(kVersion).put(kVersion);
  record.put(kDisk).put(kDisk).put(entry_count).put(entry_count).put(size).put(offset);
  record.put(kZip64Locator).put(kDisk).put(offset + size).put(std::uint32_t{1});
  record.put(kEnd).put(std::uint16_t{0}).put(std::uint16_t{0});
  record.put(static_cast<std::uint16_t>(entry_count)).put(static_cast<std::uint16_t>(entry_count));
  record.put(kInZip64).put(kInZip64).put(std::uint16_t{0});
  return record.bytes();
}

}  // namespace

std::string npy_header(const std::string& type, std::span<const std::size_t> shape) {
  constexpr std::size_t kStart = 10, kAlignment = 64;
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}",
                                 type, fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  const std::size_t unpadded = kStart + text.size() + 1;
  text.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  text += '\n';
  Record record;
  record.put_text("\x93NUMPY").put(std::uint8_t{1}).put(std::uint8_t{0});
  record.put(static_cast<std::uint16_t>(text.size())).put_text(text);
  return record.bytes();
}

std::size_t npz_bytes(std::span<const Array> arrays) {
  std::size_t bytes = end_records(0, 0, 0).size();
  for (const Array& array : arrays) {
    const Entry entry{.name = array.name + ".npy"};
    bytes += local_header(entry).size() + npy_header(array.type, array.shape).size() +
             array.data.size() + central_header(entry).size();
  }
  return bytes;
}

void write_npz(const std::filesystem::path& path, std::span<const Array> arrays, bool no_clobber) {
  AtomicFile file(path, no_clobber);
  std::string central;
  std::uint64_t offset = 0;
  for (const Array& array : arrays) {
    const std::string header = npy_header(array.type, array.shape);
    const Entry entry{.name = array.name + ".npy",
                      .crc = checksum(header, array.data),
                      .size = header.size() + array.data.size(),
                      .offset = offset};
    const std::string local = local_header(entry);
    file.write(local);
    file.write(header);
    file.write(array.data);
    central += central_header(entry);
    offset += local.size() + entry.size;
  }
  file.write(central);
  file.write(end_records(arrays.size(), central.size(), offset));
  file.commit();
}

}  // namespace prt::signal
