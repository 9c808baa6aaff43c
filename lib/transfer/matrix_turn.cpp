// Single matrices of MatrixTransfer: into a vertex's frame, and into the functions of a field.
#include <algorithm>
#include <array>

#include "sh/basis.h"
#include "sh/rotation.h"
#include "transfer/matrix.h"
#include "transfer/matrix_kernels.h"

namespace prt::transfer {

// R_p T_p, in a left-handed frame with the signs that a mirrored y gives functions of sines.
void MatrixTransfer::turn(const mesh::Frame& frame, const float* moments, float* turned) const {
  const auto& [x, y, z] = frame;
  const Vec3 right = z.cross(x);
  const bool mirrored = right.dot(y) < 0.0f;
  const sh::Rotation rotation(header_.band_count, Matrix4(x.x, right.x, z.x, 0, x.y, right.y, z.y,
                                                          0, x.z, right.z, z.z, 0, 0, 0, 0, 1));
  std::fill_n(turned, sh::row_size(header_.band_count) * moment_stride_, 0.0f);
  std::array<float, sh::row_size(2 * kMaxMatrixBandCount - 1)> block;
  for (int l = 0; l < header_.band_count; ++l) {
    const std::size_t size = static_cast<std::size_t>(2 * l + 1), first = sh::row_size(l);
    float* entry = block.data();
    for (int k = -l; k <= l; ++k) {
      for (int i = -l; i <= l; ++i) {
        const double sign = mirrored && i < 0 ? -1.0 : 1.0;
        *entry++ = static_cast<float>(sign * rotation.at(l, i, k));
      }
    }
    add_product({block.data(), size, moments + first * moment_stride_, moment_stride_,
                 turned + first * moment_stride_, moment_stride_, size, size, moment_stride_});
  }
}

void MatrixTransfer::to_field(const float* matrix, float* row) const {
  const ExitBasis& basis = reflection_->basis();
  const std::size_t n = sh::row_size(header_.band_count);
  const auto channels = static_cast<std::size_t>(header_.channel_count);
  std::vector<float> part(basis.function_count * matrix_stride_);
  for (std::size_t c = 0; c < channels; ++c) {
    std::fill(part.begin(), part.end(), 0.0f);
    add_product({basis.from_sh.data(), basis.function_count,
                 matrix + c * basis.row_count * matrix_stride_, matrix_stride_, part.data(),
                 matrix_stride_, basis.function_count, basis.row_count, matrix_stride_});
    for (std::size_t f = 0; f < basis.function_count; ++f) {
      std::copy_n(&part[f * matrix_stride_], n, row + (f * channels + c) * n);
    }
  }
}

}  // namespace prt::transfer
