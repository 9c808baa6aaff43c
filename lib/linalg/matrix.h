// Views of dense row-major matrices: element (i, j) is data[i * stride + j]. They own nothing.
#pragma once

#include <cstddef>

namespace prt::linalg {

template <class T>
struct MatrixView {
  T* data = nullptr;
  std::size_t row_count = 0;
  std::size_t column_count = 0;
  std::size_t stride = 0;  ///< elements from a row to the next, >= column_count

  MatrixView() = default;
  MatrixView(T* elements, std::size_t rows, std::size_t columns)
      : MatrixView(elements, rows, columns, columns) {}
  MatrixView(T* elements, std::size_t rows, std::size_t columns, std::size_t row_stride)
      : data(elements), row_count(rows), column_count(columns), stride(row_stride) {}

  T* row(std::size_t i) const { return data + i * stride; }
  operator MatrixView<const T>() const { return {data, row_count, column_count, stride}; }
};

using ConstMatrixF = MatrixView<const float>;
using ConstMatrixD = MatrixView<const double>;
using MatrixF = MatrixView<float>;
using MatrixD = MatrixView<double>;

}  // namespace prt::linalg
