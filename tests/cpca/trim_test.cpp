// Vectors that an encoding can spare.
#include "cpca/trim.h"

#include <gtest/gtest.h>

#include "cpca/encoder.h"
#include "cpca/surface.h"

namespace prt::cpca {
namespace {

double sum(const std::vector<double>& errors) {
  double total = 0.0;
  for (const double error : errors) total += error;
  return total;
}

TEST(TrimToBytes, LeavesWhatFits) {
  const auto signal = make_surface(900, 20);
  Encoding encoding =
      encode_adaptive(signal, 20, {.cluster_count = 12, .component_count = 4, .iterations = 4})
          .encoding;
  const StorageCost cost{};
  const std::size_t bytes = cost.bytes(encoding);
  double last = sum(point_errors(encoding, signal));
  for (const double share : {1.0, 0.99, 0.8, 0.5}) {
    const auto most = static_cast<std::size_t>(share * static_cast<double>(bytes));
    trim_to_bytes({}, cost, most, encoding);
    EXPECT_LE(cost.bytes(encoding), most);
    // No more than about a vector below, of the largest cluster.
    EXPECT_GT(cost.bytes(encoding) + 900 * sizeof(float), most);
    const double error = sum(point_errors(encoding, signal));
    EXPECT_GE(error, last * (1.0 - 1e-6));
    last = error;
  }
  trim_to_bytes({}, cost, 1, encoding);
  EXPECT_EQ(encoding.component_count, 0);
}

}  // namespace
}  // namespace prt::cpca
