// Rates per thread of the SH kernels, on blocks that stay in the cache (items_per_second is
// directions evaluated, vectors rotated), and the projection of an environment map.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "sh/basis.h"
#include "sh/light.h"
#include "sh/product.h"
#include "sh/rotation.h"

namespace prt::sh {
namespace {

constexpr std::size_t kBlock = 64;

std::vector<float> random_values(std::size_t count) {
  Pcg32 random(1);
  std::vector<float> values(count);
  for (float& value : values) value = random.uniform();
  return values;
}

void evaluate_directions(benchmark::State& state) {
  const int band_count = static_cast<int>(state.range(0));
  std::vector<float> x = random_values(kBlock), y = random_values(kBlock), z(kBlock);
  for (std::size_t i = 0; i < kBlock; ++i) {
    z[i] = 2 * y[i] - 1;
    const float phi = 6.2831853f * x[i], r = std::sqrt(1 - z[i] * z[i]);
    x[i] = r * std::cos(phi);
    y[i] = r * std::sin(phi);
  }
  std::vector<float> values(row_size(band_count) * kBlock);
  for (auto _ : state) {
    evaluate_batch(band_count, x.data(), y.data(), z.data(), kBlock, values.data(), kBlock);
    benchmark::DoNotOptimize(values.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kBlock));
}
BENCHMARK(evaluate_directions)->ArgName("bands")->Arg(3)->Arg(5)->Arg(6)->Arg(8)->Arg(10);

// The plain way that the batch is measured against.
void evaluate_directions_one_by_one(benchmark::State& state) {
  const int band_count = static_cast<int>(state.range(0));
  std::vector<float> values(row_size(band_count));
  Vec3 direction(0.48f, -0.6f, 0.64f);
  for (auto _ : state) {
    benchmark::DoNotOptimize(direction);
    evaluate(band_count, direction, values);
    benchmark::DoNotOptimize(values.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(evaluate_directions_one_by_one)->ArgName("bands")->Arg(5)->Arg(10);

Matrix4 some_rotation() {
  Matrix4 matrix;
  matrix.setAxisAngle(Vec3(1, 2, 3), 0.7f);
  return matrix;
}

void rotate_vectors(benchmark::State& state) {
  const int band_count = static_cast<int>(state.range(0));
  const Rotation rotation(band_count, some_rotation());
  const std::size_t size = row_size(band_count) * kBlock;
  const std::vector<float> from = random_values(size);
  std::vector<float> to(size);
  for (auto _ : state) {
    rotation.apply_batch(from.data(), to.data(), kBlock, kBlock);
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kBlock));
}
BENCHMARK(rotate_vectors)->ArgName("bands")->Arg(3)->Arg(5)->Arg(6)->Arg(10);

// A light rotation as the runtime does it: matrices and three channels.
void rotate_light(benchmark::State& state) {
  const Light light = directional_light(static_cast<int>(state.range(0)), {0, 1, 0}, Vec3(1));
  const Matrix4 matrix = some_rotation();
  for (auto _ : state) benchmark::DoNotOptimize(rotated(light, matrix));
}
BENCHMARK(rotate_light)->ArgName("bands")->Arg(5)->Arg(10)->Unit(benchmark::kMicrosecond);

void multiply_functions(benchmark::State& state) {
  const int band_count = static_cast<int>(state.range(0));
  const ProductTable table(band_count);
  const auto size = row_size(band_count);
  const std::vector<float> a = random_values(size), b = random_values(size);
  std::vector<float> product(size);
  for (auto _ : state) {
    table.multiply(a, b, product);
    benchmark::DoNotOptimize(product.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(multiply_functions)->ArgName("bands")->Arg(5)->Arg(10);

// Columns, bands, threads.
void project_map(benchmark::State& state) {
  const int width = static_cast<int>(state.range(0)), height = width / 2;
  set_thread_count(static_cast<int>(state.range(2)));
  const std::vector<float> map =
      random_values(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        project_environment(static_cast<int>(state.range(1)), width, height, map.data()));
  }
  set_thread_count(0);
  state.SetItemsProcessed(state.iterations() * width * height);
}
BENCHMARK(project_map)
    ->ArgNames({"columns", "bands", "threads"})
    ->Args({1024, 5, 1})
    ->Args({1024, 10, 1})
    ->Args({1024, 10, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace prt::sh

BENCHMARK_MAIN();
