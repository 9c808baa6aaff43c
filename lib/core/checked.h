// Arithmetic on counts and offsets read from files: overflow is an error, never a wrap.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/error.h"

namespace prt {

inline std::size_t checked_add(std::size_t a, std::size_t b) {
  std::size_t sum;
  if (__builtin_add_overflow(a, b, &sum)) throw_bad_input("size overflows");
  return sum;
}

inline std::size_t checked_multiply(std::size_t a, std::size_t b) {
  std::size_t product;
  if (__builtin_mul_overflow(a, b, &product)) throw_bad_input("size overflows");
  return product;
}

}  // namespace prt
