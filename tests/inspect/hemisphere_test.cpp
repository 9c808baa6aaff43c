#include "inspect/hemisphere.h"

#include <gtest/gtest.h>

namespace prt::inspect {
namespace {

TEST(InspectHemisphere, TableHoldsThePublishedFigures) {
  const Json table = hemisphere_table();
  EXPECT_NEAR(table["singular_values"]["smallest"], 6.59e-6, 0.005e-6);
  EXPECT_NEAR(table["singular_values"]["second_smallest"], 3.10e-4, 0.005e-4);
  EXPECT_NEAR(table["dropped"]["squared_error"], 1.48e-5, 0.005e-5);
  struct Row {
    const char* projection;
    int function_count;
    double worst, worst_digit, mean, mean_digit;
  };
  const Row rows[] = {{"least squares", 25, 0, 1e-9, 0, 1e-9},
                      {"least squares", 24, 1.48e-5, 1e-7, 1.48e-5 / 25, 1e-8},
                      {"zero hemisphere", 25, 0.125, 1e-3, 0.0402, 1e-4},
                      {"odd reflection", 28, 0.145, 1e-3, 0.044, 1e-3},
                      {"even reflection", 28, 0.022, 1e-3, 0.0036, 1e-4},
                      {"even reflection", 15, 0.193, 1e-3, 0.030, 1e-3}};
  ASSERT_EQ(table["projections"].size(), std::size(rows));
  for (std::size_t i = 0; i < std::size(rows); ++i) {
    const Json& row = table["projections"][i];
    EXPECT_EQ(row["projection"], rows[i].projection);
    EXPECT_EQ(row["function_count"], rows[i].function_count);
    EXPECT_NEAR(row["worst_squared_error"], rows[i].worst, rows[i].worst_digit / 2);
    EXPECT_NEAR(row["mean_squared_error"], rows[i].mean, rows[i].mean_digit / 2);
  }
}

}  // namespace
}  // namespace prt::inspect
