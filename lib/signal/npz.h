// Arrays in NumPy's .npz format: a ZIP archive of .npy files, stored as they are.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace prt::signal {

struct Array {
  std::string name;                 ///< under which numpy.load gives it
  std::string type;                 ///< NumPy's: "<f4", "<u4", …; little-endian
  std::vector<std::size_t> shape;   ///< C order
  std::span<const std::byte> data;  ///< as many bytes as type and shape say
};

template <class T>
Array make_array(std::string name, std::string type, std::vector<std::size_t> shape,
                 const std::vector<T>& values) {
  return {std::move(name), std::move(type), std::move(shape), std::as_bytes(std::span(values))};
}

/// Bytes of a .npy file in front of its values.
std::string npy_header(const std::string& type, std::span<const std::size_t> shape);

/// Bytes of the file that write_npz makes of the arrays. Beside their data they depend on the
/// names.
std::size_t npz_bytes(std::span<const Array> arrays);

/// Atomic; the same arrays give the same bytes. Sizes are those of ZIP64, so that none is too
/// large. Throws Error (failed).
void write_npz(const std::filesystem::path& path, std::span<const Array> arrays,
               bool no_clobber = false);

}  // namespace prt::signal
