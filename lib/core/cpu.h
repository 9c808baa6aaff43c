// Which vector instructions this processor has. Kernels that pay for it are compiled for several
// levels (one always-inline body, one wrapper per level with a target attribute) and chosen by
// this.
#pragma once

namespace prt {

enum class SimdLevel { baseline, avx2, avx512 };

/// The best level of this processor, or the lower one that the environment variable PRTKIT_SIMD
/// (baseline, avx2, avx512) asks for. Constant for the life of the process.
SimdLevel simd_level();
const char* simd_level_name(SimdLevel level);

/// Of one kernel's wrappers, that of a level.
template <class Kernel>
Kernel* kernel_for(SimdLevel level, Kernel* avx512, Kernel* avx2, Kernel* baseline) {
  return level == SimdLevel::avx512 ? avx512 : level == SimdLevel::avx2 ? avx2 : baseline;
}

/// The target attributes of the wrappers.
#define PRTKIT_AVX512 __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")))
#define PRTKIT_AVX2 __attribute__((target("avx2,fma")))

}  // namespace prt
