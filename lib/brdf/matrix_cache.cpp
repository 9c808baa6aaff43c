#include "brdf/matrix_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"

namespace prt::brdf {

namespace {

namespace fs = std::filesystem;

// A file is the description as text, a zero, error, exit_energy, kernel_energy and the entries of B
// as doubles of this machine, and the hash of all this. The version counts changes of the layout
// and of what the lobes and the quadrature compute.
constexpr int kVersion = 2;

std::string describe(const Lobe& lobe, int row_band_count, int column_band_count,
                     double tolerance) {
  return fmt::format("prtkit lobe matrix {}: {}, {} x {} bands, {:a}", kVersion, lobe.key(),
                     row_band_count, column_band_count, tolerance);
}

std::string hash_of(const std::string& bytes) {
  Hasher hasher;
  hasher.add(bytes.data(), bytes.size());
  return hasher.hex();
}

std::string encode(const std::string& description, const LobeMatrix& matrix) {
  std::vector<double> numbers{matrix.error, matrix.exit_energy, matrix.kernel_energy};
  numbers.insert(numbers.end(), matrix.values.begin(), matrix.values.end());
  std::string bytes = description + '\0';
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
  return bytes + hash_of(bytes);
}

/// Nothing when the file is not exactly what encode() writes for this description.
std::optional<LobeMatrix> read(const fs::path& path, const std::string& description,
                               int row_band_count, int column_band_count) {
  LobeMatrix matrix{row_band_count, column_band_count, {}, 0, 0, 0};
  const auto entry_count = static_cast<std::size_t>(row_band_count * row_band_count) *
                           static_cast<std::size_t>(column_band_count * column_band_count);
  std::vector<double> numbers(3 + entry_count);
  const std::size_t body = description.size() + 1 + numbers.size() * sizeof(double);
  const std::size_t file_size = body + 32;  // the hash is 32 digits
  std::string bytes;
  try {
    bytes = read_text_file(path, file_size);
  } catch (const Error&) {
    return std::nullopt;
  }
  if (bytes.size() != file_size || bytes.compare(0, description.size(), description) != 0 ||
      bytes.substr(body) != hash_of(bytes.substr(0, body))) {
    return std::nullopt;
  }
  std::memcpy(numbers.data(), &bytes[description.size() + 1], numbers.size() * sizeof(double));
  if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) {
    return std::nullopt;
  }
  matrix.error = numbers[0], matrix.exit_energy = numbers[1], matrix.kernel_energy = numbers[2];
  matrix.values.assign(numbers.begin() + 3, numbers.end());
  return matrix;
}

void write(const fs::path& path, const std::string& bytes) {
  try {
    fs::create_directories(path.parent_path());
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
  } catch (const std::exception& error) {
    log::debug("BRDF matrix not cached: {}", error.what());
  }
}

}  // namespace

fs::path default_cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return fs::path(value ? value : "");
  };
  if (const fs::path cache = variable("XDG_CACHE_HOME"); cache.is_absolute()) {
    return cache / "prtkit" / "brdf";
  }
  if (const fs::path home = variable("HOME"); home.is_absolute()) {
    return home / ".cache" / "prtkit" / "brdf";
  }
  return {};
}

LobeMatrix cached_lobe_matrix(const Lobe& lobe, int row_band_count, int column_band_count,
                              double tolerance, const fs::path& folder) {
  const std::string description = describe(lobe, row_band_count, column_band_count, tolerance);
  const fs::path path = folder / (hash_of(description) + ".lobe");
  if (!folder.empty()) {
    if (auto matrix = read(path, description, row_band_count, column_band_count)) return *matrix;
  }
  const LobeMatrix matrix = compute_lobe_matrix(lobe, row_band_count, column_band_count, tolerance);
  if (!folder.empty()) write(path, encode(description, matrix));
  return matrix;
}

}  // namespace prt::brdf
