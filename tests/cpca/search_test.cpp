// The search for clusters and vectors within an error or a size.
#include "cpca/search.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "cpca/figures.h"
#include "cpca/signals.h"

namespace prt::cpca {
namespace {

constexpr int kDimension = 40;

struct Counted {
  int encodings = 0;
  Encoder encoder = [this](std::span<const float> signal, int dimension, const Options& options) {
    ++encodings;
    return encode_iterative(signal, dimension, options);
  };
};

TEST(EncodeWithin, KeepsToTheErrorAtLittleCost) {
  const auto signal = make_signal(4000, kDimension, 8);
  for (const Norm norm : {Norm::rmse, Norm::maximum}) {
    std::size_t last = ~std::size_t{0};
    for (double max_error : {0.01, 0.03, 0.1}) {
      Counted counted;
      const Encoded encoded = encode_within({.max_error = max_error, .norm = norm, .max_bytes = {}},
                                            counted.encoder, signal, kDimension, {});
      EXPECT_LE(relative_error(encoded.encoding, signal, norm), max_error);
      EXPECT_LE(counted.encodings, 3);
      EXPECT_LT(storage_bytes(encoded.encoding), last);  // less for a larger error
      last = storage_bytes(encoded.encoding);
    }
    EXPECT_LT(last, signal.size());  // a quarter of its bytes
  }
}

TEST(EncodeWithin, KeepsToTheBytes) {
  const auto signal = make_signal(4000, kDimension, 8);
  double last = 0.0;
  for (std::size_t max_bytes : {200000u, 100000u, 30000u}) {
    Counted counted;
    const Encoded encoded = encode_within({.max_error = {}, .max_bytes = max_bytes},
                                          counted.encoder, signal, kDimension, {});
    EXPECT_LE(storage_bytes(encoded.encoding), max_bytes);
    EXPECT_GT(storage_bytes(encoded.encoding), max_bytes * 9 / 10);
    EXPECT_EQ(counted.encodings, 1);
    const double error = relative_error(encoded.encoding, signal, Norm::rmse);
    EXPECT_GT(error, last);  // more for fewer bytes
    last = error;
  }
}

// Small clusters have the most vectors, which take more room than the weights that pay for them.
TEST(EncodeWithin, AdaptiveKeepsToTheBytesToo) {
  const auto signal = make_uneven_signal(2000, kDimension, 4);
  for (std::size_t max_bytes : {100000u, 50000u, 30000u}) {
    const Encoded encoded = encode_within({.max_error = {}, .max_bytes = max_bytes},
                                          encode_adaptive, signal, kDimension, {.iterations = 5});
    EXPECT_LE(storage_bytes(encoded.encoding), max_bytes);
    EXPECT_GT(storage_bytes(encoded.encoding), max_bytes / 2);
  }
}

TEST(EncodeWithin, SaysWhatCannotBe) {
  const auto noise = random_values(300 * 100, 1);
  EXPECT_THROW(encode_within({.max_error = 1e-9, .max_bytes = {}}, encode_iterative, noise, 100,
                             {.iterations = 2}),
               Error);
  EXPECT_THROW(encode_within({.max_error = {}, .max_bytes = 10}, encode_iterative, noise, 100,
                             {.iterations = 2}),
               Error);
}

TEST(EncodeWithin, TakesDegenerateSignals) {
  for (const DegenerateCase& test : degenerate_cases()) {
    const Encoded encoded =
        encode_within({.max_error = 1e-4, .max_bytes = {}}, encode_iterative, test.signal, 9, {});
    EXPECT_LE(relative_error(encoded.encoding, test.signal, Norm::rmse), 1e-4) << test.name;
  }
}

}  // namespace
}  // namespace prt::cpca
