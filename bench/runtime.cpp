// Speed of the runtime: frames by every way of drawing, on one context and one model, and the CPU's
// work for a change of light. The model has the size of the Stanford bunny's bake: 34,848 vertices,
// 256 clusters of 8 vectors, colour transfer of 5 bands. Frames are 512x512 without antialiasing
// and without background, so that vertices weigh as they do on hardware that rasterises fast.
// bench_runtime a.prt.glb draws that model instead.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "cpca/superclusters.h"
#include "gl/context.h"
#include "runtime/cluster_chunks.h"
#include "runtime/cluster_constants.h"
#include "runtime/renderer.h"
#include "tests/runtime/models.h"

namespace {

using namespace prt;
using namespace prt::runtime;

constexpr int kBandCount = 5, kClusterCount = 256, kComponentCount = 8, kSize = 512;

std::filesystem::path given_model;  // of the command line

/// Clusters of neighbouring vertices, as a bake makes them, rather than scattered ones.
Model make_bench_model() {
  if (!given_model.empty()) return load_model(given_model);
  const mesh::Scene scene = scene_of({torus(264, 132)});
  gltf::PrecomputedTransfer transfer =
      random_transfer(scene.vertex_count(), kBandCount, 3, kClusterCount, kComponentCount);
  for (std::size_t p = 0; p < scene.vertex_count(); ++p) {
    const std::size_t ring = p / 132, side = p % 132;
    transfer.encoding.cluster_of_point[p] =
        static_cast<std::uint32_t>(ring * 16 / 264 * 16 + side * 16 / 132);
  }
  transfer.first_clusters = cpca::sort_clusters(
      cpca::find_superclusters(scene.indices(), transfer.encoding.cluster_of_point,
                               cpca::register_counts(transfer.encoding, 1), 256),
      transfer.encoding);
  return make_model(scene, transfer,
                    unshadowed(scene, kBandCount, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

void draw_frames(benchmark::State& state, Draw draw, bool superclusters) {
  const gl::HeadlessContext context;
  Model model = make_bench_model();
  if (draw == Draw::uncompressed && !model.signal) return state.SkipWithError("no transfer");
  if (!superclusters) model.transfer->first_clusters.clear();
  Renderer renderer;
  renderer.set_model(model);
  renderer.set_lighting(lighting_from(test_light(kBandCount)));
  View view;
  view.camera = camera::frame(model.bounds, 40, 1);
  view.draw = draw;
  renderer.draw(view, kSize, kSize, 1);
  gl::finish();
  for (auto _ : state) {
    renderer.draw(view, kSize, kSize, 1);
    gl::finish();
  }
  state.SetItemsProcessed(state.iterations());
  state.SetLabel(gl::description());
}
BENCHMARK_CAPTURE(draw_frames, compressed_single, Draw::single, false)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(draw_frames, compressed_clusters, Draw::clusters, false)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(draw_frames, compressed_superclusters, Draw::clusters, true)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(draw_frames, uncompressed, Draw::uncompressed, false)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// Rotating the light and the constants t_i·l of all clusters, on one CPU thread.
void change_light(benchmark::State& state) {
  const auto band_count = static_cast<int>(state.range(0));
  ClusterConstants constants(random_transfer(1, band_count, 3, kClusterCount, kComponentCount),
                             exit_layout(1, 1));
  const sh::Light light = test_light(band_count);
  float degrees = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(
        constants.evaluate(sh::rotated(light, light_rotation(degrees += 1))).data());
}
BENCHMARK(change_light)->Arg(5)->Arg(10)->ArgName("bands")->Unit(benchmark::kMicrosecond);

/// The same with the upload to OpenGL and the uncompressed transfer's uniforms.
void change_light_in_renderer(benchmark::State& state) {
  const gl::HeadlessContext context;
  Renderer renderer;
  renderer.set_model(make_bench_model());
  renderer.set_lighting(lighting_from(test_light(kBandCount)));
  float degrees = 0;
  for (auto _ : state) {
    renderer.set_light_rotation(light_rotation(degrees += 1));
    gl::finish();
  }
}
BENCHMARK(change_light_in_renderer)->Unit(benchmark::kMicrosecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc > 1) given_model = argv[1];
  benchmark::RunSpecifiedBenchmarks();
}
