// How good an encoding is, in numbers.
#pragma once

#include <cstddef>
#include <span>

#include "cpca/encoding.h"

namespace prt::cpca {

struct Figures {
  double squared_error = 0.0;    ///< SE of [Sloan03]: over all points and coefficients
  double signal_energy = 0.0;    ///< sum of the squares of the signal
  double max_point_error = 0.0;  ///< largest squared error of a point

  /// sqrt(squared_error / signal_energy); 0 for a signal of zeros without error.
  double relative_rmse() const;
};

/// Figures of some consecutive points: their errors (point_errors) and their rows of the signal.
Figures summarize(std::span<const double> errors, std::span<const float> rows);

/// Bytes of an encoding with float32 numbers and cluster indices of 16 bits, or 32 where they need
/// it: the storage of [Sloan03] §4.1, m_p n' + m_c (n' + 1) n numbers (fewer where clusters
/// have fewer vectors), and the indices.
std::size_t storage_bytes(const Encoding& encoding);

}  // namespace prt::cpca
