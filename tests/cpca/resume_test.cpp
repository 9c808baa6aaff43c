// Encodings and searches that were interrupted, and go on.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/file.h"
#include "cpca/search.h"
#include "cpca/signals.h"
#include "cpca/surface.h"
#include "temporary_folder.h"

namespace prt::cpca {
namespace {

void expect_same(const Encoded& found, const Encoded& expected) {
  EXPECT_EQ(found.encoding.cluster_of_point, expected.encoding.cluster_of_point);
  EXPECT_EQ(found.encoding.means, expected.encoding.means);
  EXPECT_EQ(found.encoding.bases, expected.encoding.bases);
  EXPECT_EQ(found.encoding.weights, expected.encoding.weights);
  EXPECT_EQ(found.encoding.component_counts, expected.encoding.component_counts);
  EXPECT_EQ(found.iterations, expected.iterations);
  EXPECT_EQ(found.flops, expected.flops);
  ASSERT_EQ(found.levels.size(), expected.levels.size());
  for (std::size_t i = 0; i < found.levels.size(); ++i) {
    EXPECT_EQ(found.levels[i].component_count, expected.levels[i].component_count);
    EXPECT_EQ(found.levels[i].errors, expected.levels[i].errors);
    EXPECT_EQ(found.levels[i].is_whole, expected.levels[i].is_whole);
  }
}

/// Runs make(checkpoint) beside what is left of its file after an interruption anywhere.
template <class Make>
void interrupt(const Make& make) {
  const TemporaryFolder folder;
  const CheckpointOptions options{folder / "out.partial", 0.0};
  {
    Checkpoint checkpoint(options, "key");
    make(&checkpoint);
  }
  const std::string kept = read_text_file(options.path);
  constexpr std::size_t kSteps = 9;
  for (std::size_t step = 0; step <= kSteps; ++step) {
    folder.write("out.partial", kept.substr(0, kept.size() * step / kSteps));
    Checkpoint checkpoint(options, "key");
    make(&checkpoint);
  }
}

class EncoderResume : public testing::TestWithParam<Method> {
 protected:
  const bool is_adaptive_ = GetParam() == Method::adaptive;
};

// With 128 coefficients the encoder works in principal axes, and at last in all coordinates.
TEST_P(EncoderResume, ContinuesToTheSameEncoding) {
  for (const int dimension : {12, 128}) {
    const auto signal = make_uneven_signal(1200, static_cast<std::size_t>(dimension), 3);
    Options options{.cluster_count = 10, .component_count = 3, .iterations = 12};
    const Encoded expected = encode(GetParam(), signal, dimension, options);
    EXPECT_EQ(expected.resumed_iterations, 0);
    int resumed = 0;
    interrupt([&](Checkpoint* checkpoint) {
      options.checkpoint = checkpoint;
      const Encoded encoded = encode(GetParam(), signal, dimension, options);
      expect_same(encoded, expected);
      EXPECT_GE(encoded.resumed_iterations, resumed);
      resumed = encoded.resumed_iterations;
    });
    // An adaptation goes on from its last cycle, vector quantisation ends when nothing moves.
    const int not_kept = is_adaptive_ ? 10 : GetParam() == Method::fixed ? 1 : 0;
    EXPECT_GE(resumed, expected.iterations - not_kept);
  }
}

// The latest, and the one before.
TEST_P(EncoderResume, TheFileHoldsAFewStatesHoweverManyLevels) {
  const TemporaryFolder folder;
  const auto signal = make_signal(1200, 20);
  std::size_t least = 0;
  for (const int components : {2, 8}) {
    const CheckpointOptions options{folder / std::to_string(components), 0.0};
    Checkpoint checkpoint(options, "key");
    encode(GetParam(), signal, 20,
           {.cluster_count = 10, .component_count = components, .checkpoint = &checkpoint});
    const std::size_t vectors =
        10 * (std::size_t{2} + (is_adaptive_ ? 2 : 1) * static_cast<std::size_t>(components));
    const std::size_t states = is_adaptive_ ? 4 : 2;
    const auto size = std::filesystem::file_size(options.path);
    const std::size_t state = 12 * 1200 + vectors * (32 + 2) * sizeof(float) + 4000;
    EXPECT_LT(size, (states + 2) * state * 9 / 8);  // two more where they grow out of their room
    EXPECT_GE(size, least);
    least = size;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EncoderResume,
                         testing::Values(Method::fixed, Method::iterative, Method::adaptive));

class SearchResume : public testing::TestWithParam<std::pair<Method, Norm>> {};

TEST_P(SearchResume, ContinuesToTheSameEncoding) {
  const auto [method, norm] = GetParam();
  const auto signal = make_surface(3000, 30);
  const Bound bound{.max_error = 0.03, .norm = norm, .max_bytes = {}};
  Options options{.iterations = 8};
  const Found expected = encode_within(bound, method, signal, 30, options);
  std::ptrdiff_t resumed = 0;
  interrupt([&](Checkpoint* checkpoint) {
    options.checkpoint = checkpoint;
    const Found found = encode_within(bound, method, signal, 30, options);
    expect_same(found.encoded, expected.encoded);
    EXPECT_EQ(found.flops_cost(), expected.flops_cost());
    ASSERT_EQ(found.trials.size(), expected.trials.size());
    for (std::size_t i = 0; i < found.trials.size(); ++i) {
      EXPECT_EQ(found.trials[i].choice, expected.trials[i].choice);
      EXPECT_EQ(found.trials[i].error, expected.trials[i].error);
      EXPECT_GT(found.trials[i].seconds, 0.0);
    }
    const auto count = std::ranges::count_if(found.trials, &Trial::is_resumed);
    EXPECT_GE(count, resumed);
    resumed = count;
  });
  EXPECT_EQ(resumed, std::ssize(expected.trials));
}

// Trials of both bounds are numbered through, and the survey is of the first.
TEST_P(SearchResume, ContinuesSearchesOfTwoBounds) {
  const auto [method, norm] = GetParam();
  const auto signal = make_surface(1500, 30);
  Options options{.iterations = 6};
  const auto find_both = [&] {
    Search search(method, signal, 30, options);
    const Found coarse = search.find({.max_error = 0.05, .norm = norm, .max_bytes = {}});
    return std::pair(coarse, search.find({.max_error = 0.03, .norm = norm, .max_bytes = {}}));
  };
  const auto expected = find_both();
  interrupt([&](Checkpoint* checkpoint) {
    options.checkpoint = checkpoint;
    const auto found = find_both();
    expect_same(found.first.encoded, expected.first.encoded);
    expect_same(found.second.encoded, expected.second.encoded);
    EXPECT_EQ(found.second.flops_cost(), expected.second.flops_cost());
    EXPECT_EQ(found.second.trials.size(), expected.second.trials.size());
  });
}

INSTANTIATE_TEST_SUITE_P(Methods, SearchResume,
                         testing::Values(std::pair(Method::fixed, Norm::rmse),
                                         std::pair(Method::iterative, Norm::rmse),
                                         std::pair(Method::iterative, Norm::maximum),
                                         std::pair(Method::adaptive, Norm::rmse)));

}  // namespace
}  // namespace prt::cpca
