// What all vertices send out under each light function, between two bounces of matrices: more than
// memory holds of a large model, so it stays in a file, in half floats. Two things make that
// harmless. Exit radiance is written in functions that are orthonormal on the hemisphere: rounding
// then costs 2^-12 of each coefficient and of the radiance, whatever the condition of the SH
// functions there. And the rows lie in spatial order: what one block of vertices sees is a few runs
// of the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/nameless_file.h"

namespace prt::transfer {

/// Functions orthonormal on the hemisphere that span the SH functions of a list:
/// φ_f = λ_f^(-1/2) Σ_i u_fi y_i from A's eigenpairs (sh/hemisphere.h), those that its inverse
/// leaves out left out.
struct ExitBasis {
  explicit ExitBasis(std::span<const int> functions);

  std::size_t function_count = 0;  ///< F
  std::size_t row_count = 0;       ///< functions.size()
  int band_count = 0;              ///< that hold them
  std::vector<float> from_sh;      ///< row_count × F: coefficients c_f = Σ_i from_sh[i, f] c_i
  std::vector<float> from_directions;  ///< band_count² × F: φ_f = Σ_k from_directions[k, f] y_k
};

class ExitField {
 public:
  /// A file without a name in `folder`, which goes with its owner. Throws Error (failed) when there
  /// is no room for vertex_count rows of row_size values.
  ExitField(const std::filesystem::path& folder, std::size_t vertex_count, std::size_t row_size);

  std::size_t row_size() const { return row_size_; }
  std::size_t byte_count() const { return vertex_count_ * row_size_ * sizeof(std::uint16_t); }

  /// Rows of half floats from `first` on, as many as there are values for. From any thread. Throw
  /// Error (failed).
  void write(std::size_t first, std::span<const std::uint16_t> halfs);
  void read(std::size_t first, std::span<std::uint16_t> halfs) const;

 private:
  NamelessFile file_;
  std::size_t vertex_count_, row_size_;
};

}  // namespace prt::transfer
