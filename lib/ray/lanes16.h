// Sixteen floats at a time in the registers that the compiler flags of the including source allow:
// one of AVX-512, two of AVX, four of SSE. Only for kernels that are compiled once for each
// instruction set (CMakeLists.txt); everything is in an unnamed namespace, so that no function is
// shared between them.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace prt::ray {
namespace {

#define PRT_LANES [[gnu::always_inline]] inline

#if defined(__AVX512F__)
using Register = __m512;
PRT_LANES Register broadcast_register(float a) { return _mm512_set1_ps(a); }
PRT_LANES Register load_register(const float* a) { return _mm512_loadu_ps(a); }
PRT_LANES void store_register(float* to, Register a) { _mm512_storeu_ps(to, a); }
PRT_LANES Register fused(Register a, Register b, Register c) { return _mm512_fmadd_ps(a, b, c); }
PRT_LANES Register smaller(Register a, Register b) { return _mm512_min_ps(a, b); }
PRT_LANES Register larger(Register a, Register b) { return _mm512_max_ps(a, b); }
PRT_LANES Register bits_and(Register a, Register b) { return _mm512_and_ps(a, b); }
PRT_LANES Register bits_xor(Register a, Register b) { return _mm512_xor_ps(a, b); }
PRT_LANES std::uint32_t mask_of_le(std::uint32_t m, Register a, Register b) {
  return _mm512_mask_cmp_ps_mask(static_cast<__mmask16>(m), a, b, _CMP_LE_OQ);
}
PRT_LANES std::uint32_t mask_of_lt(std::uint32_t m, Register a, Register b) {
  return _mm512_mask_cmp_ps_mask(static_cast<__mmask16>(m), a, b, _CMP_LT_OQ);
}
PRT_LANES Register selected_le(Register p, Register q, Register a, Register b) {
  return _mm512_mask_blend_ps(_mm512_cmp_ps_mask(p, q, _CMP_LE_OQ), b, a);
}
#elif defined(__AVX2__)
using Register = __m256;
PRT_LANES Register broadcast_register(float a) { return _mm256_set1_ps(a); }
PRT_LANES Register load_register(const float* a) { return _mm256_loadu_ps(a); }
PRT_LANES void store_register(float* to, Register a) { _mm256_storeu_ps(to, a); }
PRT_LANES Register fused(Register a, Register b, Register c) { return _mm256_fmadd_ps(a, b, c); }
PRT_LANES Register smaller(Register a, Register b) { return _mm256_min_ps(a, b); }
PRT_LANES Register larger(Register a, Register b) { return _mm256_max_ps(a, b); }
PRT_LANES Register bits_and(Register a, Register b) { return _mm256_and_ps(a, b); }
PRT_LANES Register bits_xor(Register a, Register b) { return _mm256_xor_ps(a, b); }
PRT_LANES std::uint32_t mask_of_le(std::uint32_t m, Register a, Register b) {
  return m & static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
}
PRT_LANES std::uint32_t mask_of_lt(std::uint32_t m, Register a, Register b) {
  return m & static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
}
PRT_LANES Register selected_le(Register p, Register q, Register a, Register b) {
  return _mm256_blendv_ps(b, a, _mm256_cmp_ps(p, q, _CMP_LE_OQ));
}
#else
using Register = __m128;
PRT_LANES Register broadcast_register(float a) { return _mm_set1_ps(a); }
PRT_LANES Register load_register(const float* a) { return _mm_loadu_ps(a); }
PRT_LANES void store_register(float* to, Register a) { _mm_storeu_ps(to, a); }
PRT_LANES Register fused(Register a, Register b, Register c) {
  return _mm_add_ps(_mm_mul_ps(a, b), c);
}
PRT_LANES Register smaller(Register a, Register b) { return _mm_min_ps(a, b); }
PRT_LANES Register larger(Register a, Register b) { return _mm_max_ps(a, b); }
PRT_LANES Register bits_and(Register a, Register b) { return _mm_and_ps(a, b); }
PRT_LANES Register bits_xor(Register a, Register b) { return _mm_xor_ps(a, b); }
PRT_LANES std::uint32_t mask_of_le(std::uint32_t m, Register a, Register b) {
  return m & static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmple_ps(a, b)));
}
PRT_LANES std::uint32_t mask_of_lt(std::uint32_t m, Register a, Register b) {
  return m & static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmplt_ps(a, b)));
}
PRT_LANES Register selected_le(Register p, Register q, Register a, Register b) {
  const Register mask = _mm_cmple_ps(p, q);
  return _mm_or_ps(_mm_and_ps(mask, a), _mm_andnot_ps(mask, b));
}
#endif

constexpr int kRegisterLanes = sizeof(Register) / sizeof(float);
constexpr int kRegisters = 16 / kRegisterLanes;

struct Lanes {
  Register part[kRegisters];
};
using Mask = std::uint32_t;  ///< a bit a lane

#define PRT_EACH_REGISTER _Pragma("GCC unroll 4") for (int k = 0; k < kRegisters; ++k)

PRT_LANES Lanes broadcast(float a) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = broadcast_register(a);
  return r;
}
PRT_LANES Lanes load(const float* a) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = load_register(a + k * kRegisterLanes);
  return r;
}
PRT_LANES void store(float* to, const Lanes& a) {
  PRT_EACH_REGISTER store_register(to + k * kRegisterLanes, a.part[k]);
}
PRT_LANES Lanes operator+(const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = a.part[k] + b.part[k];
  return r;
}
PRT_LANES Lanes operator-(const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = a.part[k] - b.part[k];
  return r;
}
PRT_LANES Lanes operator*(const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = a.part[k] * b.part[k];
  return r;
}
PRT_LANES Lanes operator/(const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = a.part[k] / b.part[k];
  return r;
}
/// a b + c, rounded once where the processor can.
PRT_LANES Lanes fma(const Lanes& a, const Lanes& b, const Lanes& c) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = fused(a.part[k], b.part[k], c.part[k]);
  return r;
}
PRT_LANES Lanes min(const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = smaller(a.part[k], b.part[k]);
  return r;
}
PRT_LANES Lanes max(const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = larger(a.part[k], b.part[k]);
  return r;
}
PRT_LANES Lanes operator&(const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = bits_and(a.part[k], b.part[k]);
  return r;
}
PRT_LANES Lanes operator^(const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = bits_xor(a.part[k], b.part[k]);
  return r;
}
/// Lanes of m in which a <= b, or a < b.
PRT_LANES Mask le(Mask m, const Lanes& a, const Lanes& b) {
  Mask r = 0;
  PRT_EACH_REGISTER r |= mask_of_le(m >> (k * kRegisterLanes), a.part[k], b.part[k])
                         << (k * kRegisterLanes);
  return r;
}
PRT_LANES Mask lt(Mask m, const Lanes& a, const Lanes& b) {
  Mask r = 0;
  PRT_EACH_REGISTER r |= mask_of_lt(m >> (k * kRegisterLanes), a.part[k], b.part[k])
                         << (k * kRegisterLanes);
  return r;
}
/// a where p <= q, else b.
PRT_LANES Lanes select_le(const Lanes& p, const Lanes& q, const Lanes& a, const Lanes& b) {
  Lanes r;
  PRT_EACH_REGISTER r.part[k] = selected_le(p.part[k], q.part[k], a.part[k], b.part[k]);
  return r;
}

#undef PRT_EACH_REGISTER

}  // namespace
}  // namespace prt::ray
