// Superclusters against a plain implementation that counts everything anew at every step.
#include "cpca/superclusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "cpca/sheet.h"

namespace prt::cpca {
namespace {

/// Pairs merged one by one, everything counted anew.
Indices plain_superclusters(const Indices& indices, const Indices& cluster_of_point,
                            const Indices& registers, std::uint32_t budget) {
  Indices group(registers.size());
  std::iota(group.begin(), group.end(), 0u);
  for (;;) {
    Indices labels, sizes(registers.size());
    for (const std::uint32_t cluster : cluster_of_point) labels.push_back(group[cluster]);
    for (std::size_t k = 0; k < group.size(); ++k) sizes[group[k]] += registers[k];
    std::size_t best_gain = 0;
    std::uint32_t best_low = 0, best_high = 0;
    for (std::uint32_t low = 0; low < group.size(); ++low) {
      for (std::uint32_t high = low + 1; high < group.size(); ++high) {
        if (sizes[low] == 0 || sizes[high] == 0 || sizes[low] + sizes[high] > budget) continue;
        Indices merged = labels;
        std::replace(merged.begin(), merged.end(), high, low);
        const std::size_t gain =
            plain_sent_count(indices, labels) - plain_sent_count(indices, merged);
        if (gain <= best_gain) continue;
        best_gain = gain;
        best_low = low;
        best_high = high;
      }
    }
    if (best_gain == 0) break;
    std::replace(group.begin(), group.end(), best_high, best_low);
  }
  Indices numbers = group;  // groups are named by their lowest cluster
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (std::uint32_t& g : group) {
    g = static_cast<std::uint32_t>(std::lower_bound(numbers.begin(), numbers.end(), g) -
                                   numbers.begin());
  }
  return group;
}

TEST(Superclusters, AreThoseOfThePlainGreedySearch) {
  const Sheet sheet(25, 3);
  Indices registers = register_counts(sheet.encoding, 1);
  EXPECT_EQ(registers, Indices(25, 4u));
  registers[3] = 9;  // adaptive clusters differ
  for (const std::uint32_t budget : {1u, 8u, 16u, 29u, 256u}) {
    const Indices found =
        find_superclusters(sheet.indices, sheet.encoding.cluster_of_point, registers, budget);
    EXPECT_EQ(found, plain_superclusters(sheet.indices, sheet.encoding.cluster_of_point, registers,
                                         budget))
        << budget;
    const std::uint32_t count = *std::max_element(found.begin(), found.end()) + 1;
    if (budget == 1) {
      EXPECT_EQ(count, 25u);
    }  // nothing fits, everything stays
    if (budget == 256) {
      EXPECT_EQ(count, 1u);
    }  // the sheet is connected
    for (std::uint32_t s = 0; s < count && budget >= 9; ++s) {
      std::uint32_t size = 0;
      for (std::size_t k = 0; k < 25; ++k) size += found[k] == s ? registers[k] : 0;
      EXPECT_LE(size, budget);
    }
  }
}

TEST(Superclusters, NeedTheRegistersOfThePaper) {
  // [Sloan03] §6.2: m_s (n' + 1) for diffuse, m_s (n' + 1) N_r / 4 for glossy transfer.
  Encoding encoding;
  encoding.cluster_count = 2;
  encoding.component_count = 8;
  EXPECT_EQ(register_counts(encoding, 1), Indices({9, 9}));
  EXPECT_EQ(register_counts(encoding, 16), Indices({36, 36}));
  EXPECT_EQ(register_counts(encoding, 25), Indices({63, 63}));
  encoding.component_counts = {0, 8};
  EXPECT_EQ(register_counts(encoding, 1), Indices({1, 9}));
}

TEST(Superclusters, SortingClustersLeavesTheReconstruction) {
  Sheet sheet(25, 3);
  sheet.encoding.component_counts.assign(25, 3);
  sheet.encoding.component_counts[7] = 2;
  const Encoding before = sheet.encoding;
  const Indices superclusters =
      find_superclusters(sheet.indices, before.cluster_of_point, register_counts(before, 1), 20);
  const Indices first = sort_clusters(superclusters, sheet.encoding);
  EXPECT_NE(sheet.encoding.cluster_of_point, before.cluster_of_point);
  std::vector<float> expected(Sheet::kDimension), found(Sheet::kDimension);
  for (std::size_t p = 0; p < before.point_count; ++p) {
    reconstruct(before, p, expected);
    reconstruct(sheet.encoding, p, found);
    EXPECT_EQ(found, expected);
  }
  Indices labels;
  for (const std::uint32_t cluster : before.cluster_of_point) {
    labels.push_back(superclusters[cluster]);
  }
  EXPECT_EQ(superclusters_of_points(sheet.encoding, first), labels);
  EXPECT_TRUE(std::is_sorted(first.begin(), first.end()));
  EXPECT_EQ(first.front(), 0u);
}

}  // namespace
}  // namespace prt::cpca
