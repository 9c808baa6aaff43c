#include "transfer/matrix_field.h"

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

[[noreturn]] void throw_system(const std::string& doing, const NamelessFile& file, int error) {
  throw_failed(doing + " a temporary file failed: " + std::strerror(error),
               {.file = file.folder().string()});
}

}  // namespace

ExitField::ExitField(const std::filesystem::path& folder, std::size_t vertex_count,
                     std::size_t row_size)
    : file_(folder), vertex_count_(vertex_count), row_size_(row_size) {
  file_.grow(byte_count());
}

void ExitField::write(std::size_t first, std::span<const std::uint16_t> halfs) {
  assert(first * row_size_ + halfs.size() <= vertex_count_ * row_size_);
  const char* from = reinterpret_cast<const char*>(halfs.data());
  std::size_t left = halfs.size() * sizeof(std::uint16_t);
  auto offset = static_cast<off_t>(first * row_size_ * sizeof(std::uint16_t));
  while (left > 0) {
    const ssize_t count = pwrite(file_.descriptor(), from, left, offset);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw_system("writing", file_, errno);
    from += count, offset += count, left -= static_cast<std::size_t>(count);
  }
}

void ExitField::read(std::size_t first, std::span<std::uint16_t> halfs) const {
  assert(first * row_size_ + halfs.size() <= vertex_count_ * row_size_);
  char* to = reinterpret_cast<char*>(halfs.data());
  std::size_t left = halfs.size() * sizeof(std::uint16_t);
  auto offset = static_cast<off_t>(first * row_size_ * sizeof(std::uint16_t));
  while (left > 0) {
    const ssize_t count = pread(file_.descriptor(), to, left, offset);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw_system("reading", file_, errno);
    to += count, offset += count, left -= static_cast<std::size_t>(count);
  }
}

}  // namespace prt::transfer
