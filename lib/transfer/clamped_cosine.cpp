#include "transfer/clamped_cosine.h"

#include "sh/zonal.h"

namespace prt::transfer {

void clamped_cosine(int band_count, const Vec3& normal, std::span<float> coefficients) {
  sh::turn_lobe(sh::cosine_lobe(band_count), normal, coefficients);
}

}  // namespace prt::transfer
