#include "signal/prescan.h"

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"

namespace prt::signal {

namespace {

constexpr std::size_t kLongestName = 255;
constexpr std::string_view kMagic = "\x76\x2f\x31\x01";

/// A zero-terminated name; empty at the end of the header or of the file.
std::string read_name(std::istream& stream) {
  std::string name;
  std::getline(stream, name, '\0');
  return stream && name.size() <= kLongestName ? name : std::string();
}

}  // namespace

void prescan_header(const std::filesystem::path& path) {
  const auto file_bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  const auto reject = [&](const std::string& element) {
    throw_bad_input("the header claims more than the file holds",
                    {.file = path.string(), .element = element});
  };
  std::ifstream stream(path, std::ios::binary);
  char start[8] = {};  // magic number and version
  if (!stream.read(start, sizeof start) || !std::string_view(start, 4).starts_with(kMagic)) {
    return;  // OpenEXR says so
  }
  for (std::string name = read_name(stream); !name.empty(); name = read_name(stream)) {
    const std::string type = read_name(stream);
    std::int32_t size = 0;
    if (!stream.read(reinterpret_cast<char*>(&size), sizeof(size))) return;
    if (size < 0 || size > file_bytes) reject("attribute " + name);
    if (name == "dataWindow" && size == 16) {
      std::int32_t window[4] = {};
      stream.read(reinterpret_cast<char*>(window), sizeof(window));
      const auto height = std::int64_t{window[3]} - window[1] + 1;
      // ZIP stores 16 scanlines a chunk, the most of what is read here.
      if (height / 16 * 8 > file_bytes) reject("data window");
    } else {
      stream.ignore(size);
    }
  }
}

}  // namespace prt::signal
