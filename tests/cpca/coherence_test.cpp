// Cluster coherence against plain implementations that count everything anew at every step.
#include "cpca/coherence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "cpca/empty_clusters.h"
#include "cpca/encoder.h"
#include "cpca/meshes.h"
#include "cpca/overdraw.h"
#include "cpca/projection.h"
#include "cpca/reclassify.h"
#include "cpca/sheet.h"
#include "cpca/superclusters.h"

namespace prt::cpca {
namespace {

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// The same greedy search, every quotient computed anew before every move.
Encoding plainly_reclassified(const Sheet& sheet, double error_budget) {
  Encoding encoding = sheet.encoding;
  const auto n = static_cast<std::size_t>(encoding.dimension);
  double room = error_budget * total(point_errors(encoding, sheet.signal));
  for (;;) {
    const auto errors = point_errors(encoding, sheet.signal);
    const auto sent = static_cast<int>(plain_sent_count(sheet.indices, encoding.cluster_of_point));
    std::optional<Move> best;
    for (std::uint32_t p = 0; p < encoding.point_count; ++p) {
      std::set<std::uint32_t> candidates;
      for (std::size_t i = 0; i < sheet.indices.size(); i += 3) {
        const auto corner = sheet.indices.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::find(corner, corner + 3, p) == corner + 3) continue;
        for (int j = 0; j < 3; ++j) candidates.insert(encoding.cluster_of_point[corner[j]]);
      }
      for (const std::uint32_t cluster : candidates) {
        Indices labels = encoding.cluster_of_point;
        labels[p] = cluster;
        const int reduction = sent - static_cast<int>(plain_sent_count(sheet.indices, labels));
        std::vector<float> weights(static_cast<std::size_t>(encoding.component_count));
        const double error = project_point(encoding, static_cast<int>(cluster),
                                           std::span(sheet.signal).subspan(p * n, n), weights);
        const Move move{p, cluster, reduction, error - errors[p]};
        if (reduction > 0 && move.increase <= room && (!best || is_better(move, *best))) {
          best = move;
        }
      }
    }
    if (!best) return encoding;
    room -= std::max(best->increase, 0.0);
    encoding.cluster_of_point[best->point] = best->cluster;
    const auto components = static_cast<std::size_t>(encoding.component_count);
    project_point(encoding, static_cast<int>(best->cluster),
                  std::span(sheet.signal).subspan(best->point * n, n),
                  std::span(encoding.weights).subspan(best->point * components, components));
  }
}

TEST(Overdraw, IsTheMeanNumberOfClustersOfATriangle) {
  const Indices indices{0, 1, 2, 1, 2, 3, 2, 3, 4, 4, 4, 4};
  const Indices labels{7, 7, 7, 9, 3};
  EXPECT_EQ(sent_triangle_count(indices, labels), 1u + 2u + 3u + 1u);
  EXPECT_DOUBLE_EQ(overdraw(sent_triangle_count(indices, labels), 4), 7.0 / 4.0);
  EXPECT_EQ(overdraw(0, 0), 1.0);
}

TEST(ProjectPoint, GivesTheWeightsAndErrorsOfTheEncoder) {
  const Sheet sheet;
  const auto errors = point_errors(sheet.encoding, sheet.signal);
  std::vector<float> weights(2);
  for (std::size_t p = 0; p < errors.size(); ++p) {
    const auto x = std::span(sheet.signal).subspan(p * Sheet::kDimension, Sheet::kDimension);
    const auto cluster = static_cast<int>(sheet.encoding.cluster_of_point[p]);
    EXPECT_NEAR(project_point(sheet.encoding, cluster, x, weights), errors[p], 1e-5);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(weights[i], sheet.encoding.weights[2 * p + i], 1e-5);
    }
  }
}

TEST(Reclassify, IsThePlainGreedySearch) {
  for (const double budget : {0.0, 0.01, 0.05, 0.3}) {
    Sheet sheet;
    const Encoding expected = plainly_reclassified(sheet, budget);
    const Reclassification found = reclassify(sheet.signal, sheet.indices, budget, sheet.encoding);
    EXPECT_EQ(sheet.encoding.cluster_of_point, expected.cluster_of_point) << budget;
    EXPECT_EQ(sheet.encoding.weights, expected.weights) << budget;
    if (budget > 0.0) {
      EXPECT_GT(found.moved_count, 5u);
    }
  }
}

TEST(Reclassify, KeepsWithinTheBudgetAndSendsFewerTrianglesForMore) {
  double last_sent = 1e9;
  for (const double budget : {0.0, 0.02, 0.05, 0.1, 1.0}) {
    Sheet sheet(30, 3);
    const std::size_t before = sent_triangle_count(sheet.indices, sheet.encoding.cluster_of_point);
    const Reclassification moved = reclassify(sheet.signal, sheet.indices, budget, sheet.encoding);
    const std::size_t after = sent_triangle_count(sheet.indices, sheet.encoding.cluster_of_point);
    EXPECT_LE(after, before);
    EXPECT_LE(static_cast<double>(after), last_sent);
    last_sent = static_cast<double>(after);
    EXPECT_LE(moved.final_error, (1.0 + budget) * moved.initial_error * (1 + 1e-12));
    EXPECT_NEAR(moved.final_error, total(point_errors(sheet.encoding, sheet.signal)),
                1e-9 * moved.final_error);
  }
  EXPECT_GT(last_sent, 0.0);
}

TEST(Reclassify, TakesWhatReducesTheErrorFirstAndForFree) {
  Sheet sheet;
  const double before = total(point_errors(sheet.encoding, sheet.signal));
  const Reclassification moved = reclassify(sheet.signal, sheet.indices, 0.0, sheet.encoding);
  EXPECT_GT(moved.moved_count, 0u);
  EXPECT_LT(total(point_errors(sheet.encoding, sheet.signal)), before);
}

TEST(Reclassify, WeightsOfVectorsThatAClusterLacksAreZero) {
  Sheet sheet(14, 3);
  Encoding& encoding = sheet.encoding;
  for (int k = 0; k < encoding.cluster_count; ++k) {
    encoding.component_counts.push_back(static_cast<std::uint32_t>(k % 4));
    for (int i = k % 4; i < 3; ++i) {
      const auto basis = encoding.basis(k, i);
      std::fill_n(encoding.bases.begin() + (basis.data() - encoding.bases.data()), basis.size(),
                  0.0f);
    }
  }
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    for (std::size_t i = encoding.component_counts[encoding.cluster_of_point[p]]; i < 3; ++i) {
      encoding.weights[3 * p + i] = 0.0f;
    }
  }
  ASSERT_GT(reclassify(sheet.signal, sheet.indices, 0.1, encoding).moved_count, 5u);
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    for (std::size_t i = encoding.component_counts[encoding.cluster_of_point[p]]; i < 3; ++i) {
      EXPECT_EQ(encoding.weights[3 * p + i], 0.0f);
    }
  }
}

TEST(Reclassify, IsTheSameForAnyNumberOfThreads) {
  Sheet one(40, 2), many(40, 2);
  set_thread_count(1);
  reclassify(one.signal, one.indices, 0.05, one.encoding);
  set_thread_count(4);
  reclassify(many.signal, many.indices, 0.05, many.encoding);
  set_thread_count(0);
  EXPECT_EQ(one.encoding.cluster_of_point, many.encoding.cluster_of_point);
  EXPECT_EQ(one.encoding.weights, many.encoding.weights);
}

TEST(Coherence, OverdrawFallsStepByStep) {
  Sheet sheet(30, 3);
  const Coherence coherence =
      make_coherent(sheet.signal, sheet.indices, 1, {.register_budget = 32}, sheet.encoding);
  EXPECT_EQ(coherence.triangle_count, sheet.indices.size() / 3);
  EXPECT_LT(coherence.sent_reclassified, coherence.sent_initial);
  EXPECT_LT(coherence.sent_superclustered, coherence.sent_reclassified);
  EXPECT_GE(coherence.sent_superclustered, coherence.triangle_count);
  EXPECT_EQ(coherence.sent_reclassified,
            plain_sent_count(sheet.indices, sheet.encoding.cluster_of_point));
  EXPECT_LE(coherence.final_error, 1.05 * coherence.initial_error);
}

TEST(EmptyClusters, AreLeftOutAndPointsReconstructAsBefore) {
  Sheet sheet(14, 3);
  Encoding& encoding = sheet.encoding;
  for (std::uint32_t& cluster : encoding.cluster_of_point)
    if (cluster == 0 || cluster == 5 || cluster == 13) cluster = 6;
  for (const bool adaptive : {false, true}) {
    Encoding before = encoding;
    if (adaptive) {  // cluster 5 alone has three vectors
      before.component_counts.assign(14, 2);
      before.component_counts[3] = 0;
      before.component_counts[5] = 3;
      before.component_counts[12] = 1;
    }
    Encoding after = before;
    drop_empty_clusters(after);
    EXPECT_EQ(after.cluster_count, 11);
    EXPECT_EQ(after.component_count, adaptive ? 2 : 3);
    EXPECT_EQ(after.component_counts.size(), adaptive ? 11u : 0u);
    EXPECT_EQ(after.means.size(), 11u * Sheet::kDimension);
    EXPECT_EQ(point_errors(after, sheet.signal), point_errors(before, sheet.signal));
    const std::vector<float> weights = after.weights;
    drop_empty_clusters(after);
    EXPECT_EQ(after.cluster_count, 11);
    EXPECT_EQ(after.weights, weights);
  }
}

TEST(Coherence, LeavesNoClusterEmpty) {
  Sheet sheet(60, 1);
  Encoding reclassified = sheet.encoding;
  reclassify(sheet.signal, sheet.indices, 10.0, reclassified);
  const Indices& labels = reclassified.cluster_of_point;
  const std::set<std::uint32_t> used(labels.begin(), labels.end());
  ASSERT_LT(used.size(), 60u);
  const Coherence coherence =
      make_coherent(sheet.signal, sheet.indices, 1, {.error_budget = 10.0, .register_budget = 16},
                    sheet.encoding);
  EXPECT_EQ(sheet.encoding.cluster_count, static_cast<int>(used.size()));
  const Indices& stored = sheet.encoding.cluster_of_point;
  EXPECT_EQ(std::set<std::uint32_t>(stored.begin(), stored.end()).size(), used.size());
  EXPECT_LT(coherence.first_clusters.back(), used.size());
  EXPECT_EQ(point_errors(sheet.encoding, sheet.signal), point_errors(reclassified, sheet.signal));
}

TEST(Coherence, DegenerateMeshesAreLeftAlone) {
  Sheet sheet(14, 2);
  const Encoding before = sheet.encoding;
  const Coherence nothing = make_coherent(sheet.signal, {}, 1, {}, sheet.encoding);
  EXPECT_EQ(nothing.moved_count + nothing.triangle_count + nothing.sent_superclustered, 0u);
  EXPECT_EQ(nothing.first_clusters.size(), 14u);
  EXPECT_EQ(sheet.encoding.cluster_of_point, before.cluster_of_point);
  // Triangles that are points or edges, and one that is given three times.
  const Indices odd{0, 0, 0, 1, 1, 2, 3, 4, 5, 3, 4, 5, 5, 4, 3};
  const Coherence coherence =
      make_coherent(sheet.signal, odd, 1, {.error_budget = 10.0}, sheet.encoding);
  EXPECT_LE(coherence.sent_reclassified, coherence.sent_initial);
  EXPECT_EQ(coherence.sent_reclassified, plain_sent_count(odd, sheet.encoding.cluster_of_point));
  Sheet one(1, 2);
  EXPECT_EQ(make_coherent(one.signal, one.indices, 1, {}, one.encoding).sent_initial,
            one.indices.size() / 3);
}

TEST(Coherence, AnEdgeOfManyTrianglesIsAnEdgeLikeOthers) {
  Sheet sheet(14, 2);
  Indices fan;  // 0 and 1 belong to every triangle
  for (std::uint32_t p = 2; p < 200; ++p) fan.insert(fan.end(), {0, 1, p});
  const Reclassification moved = reclassify(sheet.signal, fan, 0.2, sheet.encoding);
  EXPECT_GT(moved.moved_count, 0u);
  EXPECT_LE(moved.final_error, 1.2 * moved.initial_error);
}

TEST(Coherence, RefusesBudgetsAndMeshesThatMakeNoSense) {
  Sheet sheet;
  const auto run = [&](const std::vector<float>& signal, const Indices& indices, double budget) {
    make_coherent(signal, indices, 1, {.error_budget = budget}, sheet.encoding);
  };
  EXPECT_THROW(run(sheet.signal, sheet.indices, -0.1), Error);
  EXPECT_THROW(run(sheet.signal, sheet.indices, NAN), Error);
  EXPECT_THROW(run(sheet.signal, {0, 1, Sheet::kColumns * Sheet::kRows}, 0.05), Error);
  EXPECT_THROW(run(std::vector<float>(Sheet::kDimension), sheet.indices, 0.05), Error);
}

}  // namespace
}  // namespace prt::cpca
