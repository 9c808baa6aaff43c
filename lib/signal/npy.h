// Matrices in NumPy's .npy format (versions 1 to 3): signals of any origin, to compress as they
// are.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace prt::signal {

struct Matrix {
  std::vector<float> values;  ///< row_count × column_count
  std::size_t row_count = 0;
  std::size_t column_count = 0;
};

/// Reads float32 or float64, little-endian, in C order; a list of numbers is a matrix of one
/// column, so that rows are what NumPy iterates over. Doubles are rounded. Throws Error
/// (bad_input), naming the file, what is wrong and what it should be: another type or order, more
/// than two dimensions, a file of another length than its header says, values that would need more
/// than `max_bytes` as floats, values that are not finite, with row and column, or beyond the range
/// of float.
Matrix read_npy(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{16} << 30);

}  // namespace prt::signal
