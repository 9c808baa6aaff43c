// Rates per thread of the SH kernels, on blocks that stay in the cache: directions evaluated,
// vectors rotated.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "sh/basis.h"

namespace prt::sh {
namespace {

constexpr std::size_t kBlock = 64;

void evaluate_directions(benchmark::State& state) {
  const int band_count = static_cast<int>(state.range(0));
  Pcg32 random(1);
  std::vector<float> x(kBlock), y(kBlock), z(kBlock);
  for (std::size_t i = 0; i < kBlock; ++i) {
    z[i] = 2 * random.uniform() - 1;
    const float phi = 6.2831853f * random.uniform(), r = std::sqrt(1 - z[i] * z[i]);
    x[i] = r * std::cos(phi);
    y[i] = r * std::sin(phi);
  }
  std::vector<float> values(static_cast<std::size_t>(coefficient_count(band_count)) * kBlock);
  for (auto _ : state) {
    evaluate_batch(band_count, x.data(), y.data(), z.data(), kBlock, values.data(), kBlock);
    benchmark::DoNotOptimize(values.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kBlock));
}
BENCHMARK(evaluate_directions)->ArgName("bands")->Arg(3)->Arg(5)->Arg(6)->Arg(8)->Arg(10);

}  // namespace
}  // namespace prt::sh

BENCHMARK_MAIN();
