#include "reference/sampler.h"

#include <array>

namespace prt::reference {

namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// A permutation in which a bit is changed only by lower ones; constants of [Burley 2020].
std::uint32_t permute_upwards(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  return reverse_bits(permute_upwards(reverse_bits(x), seed));
}

// The second dimension is linear over GF(2) in the bits of the index: a table for each byte.
using Table = std::array<std::array<std::uint32_t, 256>, 4>;
constexpr Table make_second_dimension() {
  Table table{};
  std::uint32_t column = 0x80000000u;  // of Pascal's triangle modulo 2
  for (unsigned bit = 0; bit < 32; ++bit) {
    for (unsigned value = 0; value < 256; ++value) {
      if (value >> (bit % 8) & 1) table[bit / 8][value] ^= column;
    }
    column ^= column >> 1;
  }
  return table;
}
constexpr Table kSecondDimension = make_second_dimension();

float to_unit(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

}  // namespace

std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b) {
  std::uint64_t x = (std::uint64_t{a} << 32 | b) + 0x9e3779b97f4a7c15ull;  // SplitMix64's finaliser
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return static_cast<std::uint32_t>((x ^ (x >> 31)) >> 32);
}

Vec2 sobol_point(std::uint32_t index, std::uint32_t seed) {
  index = owen_scramble(index, seed);
  const std::uint32_t x = reverse_bits(index);
  const std::uint32_t y = kSecondDimension[0][index & 255] ^ kSecondDimension[1][index >> 8 & 255] ^
                          kSecondDimension[2][index >> 16 & 255] ^ kSecondDimension[3][index >> 24];
  return {to_unit(owen_scramble(x, hash_combine(seed, 1))),
          to_unit(owen_scramble(y, hash_combine(seed, 2)))};
}

}  // namespace prt::reference
