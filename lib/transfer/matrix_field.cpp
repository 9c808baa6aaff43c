#include "transfer/matrix_field.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>

#include "core/error.h"
#include "linalg/decompose.h"
#include "sh/basis.h"
#include "sh/hemisphere.h"
#include "transfer/matrix_kernels.h"

namespace prt::transfer {

ExitBasis::ExitBasis(std::span<const int> functions)
    : row_count(functions.size()), band_count(sh::band_count_of(functions)) {
  std::vector<double> gram = sh::hemisphere_gram(functions, functions);
  const auto [values, vectors] =
      linalg::largest_eigenpairs(linalg::MatrixD(gram.data(), row_count, row_count), row_count);
  while (function_count < row_count && values[function_count] >= sh::kMinimumEigenvalue) {
    ++function_count;
  }
  from_sh.resize(row_count * function_count);
  from_directions.resize(sh::row_size(band_count) * function_count);
  for (std::size_t f = 0; f < function_count; ++f) {
    const double root = std::sqrt(values[f]);
    for (std::size_t i = 0; i < row_count; ++i) {
      const double u = vectors[f * row_count + i];
      const auto k = static_cast<std::size_t>(functions[i]);
      from_sh[i * function_count + f] = static_cast<float>(root * u);
      from_directions[k * function_count + f] = static_cast<float>(u / root);
    }
  }
}

namespace {

[[noreturn]] void throw_system(const std::string& what, const std::filesystem::path& folder,
                               int error) {
  throw_failed(what + ": " + std::strerror(error), {.file = folder.string()});
}

int open_nameless(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) return descriptor;
  // Some file systems have no nameless files.
  std::string pattern = (folder / ".prtkit.XXXXXX").string();
  const int named = mkostemp(pattern.data(), O_CLOEXEC);
  if (named < 0) throw_system("cannot create a temporary file", folder, errno);
  unlink(pattern.c_str());
  return named;
}

}  // namespace

ExitField::ExitField(const std::filesystem::path& folder, std::size_t vertex_count,
                     std::size_t row_size)
    : folder_(folder), vertex_count_(vertex_count), row_size_(row_size) {
  descriptor_ = open_nameless(folder);
  if (byte_count() == 0) return;
  const int error = posix_fallocate(descriptor_, 0, static_cast<off_t>(byte_count()));
  if (error == 0) return;
  close(descriptor_);
  throw_failed("no room for what surfaces reflect",
               {.file = folder.string(),
                .found = std::strerror(error),
                .expected = fmt::format("{} MB of space for the time of the work",
                                        (byte_count() >> 20) + 1)});
}

ExitField::~ExitField() { close(descriptor_); }

void ExitField::write(std::size_t first, std::span<const std::uint16_t> halfs) {
  assert(first * row_size_ + halfs.size() <= vertex_count_ * row_size_);
  const char* from = reinterpret_cast<const char*>(halfs.data());
  std::size_t left = halfs.size() * sizeof(std::uint16_t);
  auto offset = static_cast<off_t>(first * row_size_ * sizeof(std::uint16_t));
  while (left > 0) {
    const ssize_t count = pwrite(descriptor_, from, left, offset);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw_system("writing a temporary file failed", folder_, errno);
    from += count, offset += count, left -= static_cast<std::size_t>(count);
  }
}

void ExitField::read(std::size_t first, std::span<std::uint16_t> halfs) const {
  assert(first * row_size_ + halfs.size() <= vertex_count_ * row_size_);
  char* to = reinterpret_cast<char*>(halfs.data());
  std::size_t left = halfs.size() * sizeof(std::uint16_t);
  auto offset = static_cast<off_t>(first * row_size_ * sizeof(std::uint16_t));
  while (left > 0) {
    const ssize_t count = pread(descriptor_, to, left, offset);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw_system("reading a temporary file failed", folder_, errno);
    to += count, offset += count, left -= static_cast<std::size_t>(count);
  }
}

}  // namespace prt::transfer
