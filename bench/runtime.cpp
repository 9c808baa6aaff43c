// Speed of the runtime: frames by every way of drawing, on one context and one model, and the CPU's
// work for a change of light. The model has the size of the Stanford bunny's bake: 34,848 vertices,
// 256 clusters of 8 vectors, colour transfer of 5 bands, diffuse or of 24 exit rows. Frames are
// 512x512 without antialiasing and without background, so that vertices weigh as they do on
// hardware that rasterises fast; those of "vertices" are 4x4, which leaves little else but vertices
// to do. bench_runtime a.prt.glb [a.transfer.exr] draws that model instead,
// whatever the benchmark's name says.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <utility>

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

std::filesystem::path given_model, given_transfer;  // of the command line

/// Clusters of neighbouring vertices, as a bake makes them, rather than scattered ones. The
/// uncompressed signal is some signal of the same shape.
Model make_bench_model(int row_count, int channel_count, std::uint32_t ring_count = 264) {
  if (!given_model.empty()) return load_model(given_model, given_transfer);
  const mesh::Scene scene = scene_of({torus(ring_count, 132)});
  gltf::PrecomputedTransfer transfer = random_transfer(
      scene.vertex_count(), kBandCount, channel_count, kClusterCount, kComponentCount, row_count);
  for (std::size_t p = 0; p < scene.vertex_count(); ++p) {
    const std::size_t ring = p / 132, side = p % 132;
    transfer.encoding.cluster_of_point[p] =
        static_cast<std::uint32_t>(ring * 16 / ring_count * 16 + side * 16 / 132);
  }
  transfer.first_clusters = cpca::sort_clusters(
      cpca::find_superclusters(scene.indices(), transfer.encoding.cluster_of_point,
                               cpca::register_counts(transfer.encoding, row_count), 256),
      transfer.encoding);
  signal::TransferSignal signal;
  signal.band_count = kBandCount;
  signal.row_count = row_count;
  signal.channel_count = channel_count;
  signal.blocks = {{"torus", scene.vertex_count()}};
  signal.values.assign(scene.vertex_count() * static_cast<std::size_t>(signal.dimension()), 0.01f);
  return make_model(scene, transfer, std::move(signal));
}

/// How frames are drawn; with `turning` every frame has another light.
struct Frames {
  Draw draw = Draw::single;
  Sums sums = Sums::every_frame;
  bool turning = false;
  int size = kSize;
  ExitOptions exit{};
  bool superclusters = true;
  std::uint32_t ring_count = 264;  // of 132 vertices
};

void draw_frames(benchmark::State& state, int row_count, const Frames& frames) {
  const gl::HeadlessContext context;
  Model model = make_bench_model(row_count, 3, frames.ring_count);
  if (frames.draw == Draw::uncompressed && !model.signal) return state.SkipWithError("no transfer");
  if (!frames.superclusters) model.transfer->first_clusters.clear();
  Renderer renderer;
  renderer.set_model(model, frames.exit);
  renderer.set_lighting(lighting_from(test_light(kBandCount)));
  View view;
  view.camera = camera::frame(model.bounds, 40, 1);
  view.draw = frames.draw;
  view.sums = frames.sums;
  renderer.draw(view, frames.size, frames.size, 1);
  gl::finish();
  float degrees = 0;
  for (auto _ : state) {
    if (frames.turning) renderer.set_light_rotation(light_rotation(degrees += 1));
    renderer.draw(view, frames.size, frames.size, 1);
    gl::finish();
  }
  state.SetItemsProcessed(state.iterations());
  state.SetLabel(gl::description());
}

#define DRAW_FRAMES(name, row_count, ...)                               \
  BENCHMARK_CAPTURE(draw_frames, name, row_count, (Frames __VA_ARGS__)) \
      ->MeasureProcessCPUTime()                                         \
      ->UseRealTime()                                                   \
      ->Unit(benchmark::kMillisecond)
#define DRAW_FRAMES_OF(kind, row_count)                                                          \
  DRAW_FRAMES(kind##_single, row_count, {});                                                     \
  DRAW_FRAMES(kind##_single_vertices, row_count, {.size = 4});                                   \
  DRAW_FRAMES(kind##_single_turning, row_count, {.turning = true});                              \
  DRAW_FRAMES(kind##_kept, row_count, {.sums = Sums::kept});                                     \
  DRAW_FRAMES(kind##_kept_vertices, row_count, {.sums = Sums::kept, .size = 4});                 \
  DRAW_FRAMES(kind##_kept_turning, row_count, {.sums = Sums::kept, .turning = true});            \
  DRAW_FRAMES(kind##_uncompressed, row_count, {.draw = Draw::uncompressed});                     \
  DRAW_FRAMES(kind##_uncompressed_vertices, row_count, {.draw = Draw::uncompressed, .size = 4}); \
  DRAW_FRAMES(kind##_uncompressed_turning, row_count,                                            \
              {.draw = Draw::uncompressed, .turning = true});                                    \
  DRAW_FRAMES(kind##_uncompressed_kept, row_count,                                               \
              {.draw = Draw::uncompressed, .sums = Sums::kept});                                 \
  DRAW_FRAMES(kind##_uncompressed_kept_turning, row_count,                                       \
              {.draw = Draw::uncompressed, .sums = Sums::kept, .turning = true});                \
  DRAW_FRAMES(kind##_clusters, row_count, {.draw = Draw::clusters, .superclusters = false});     \
  DRAW_FRAMES(kind##_superclusters, row_count, {.draw = Draw::clusters})
DRAW_FRAMES_OF(diffuse, 1);
DRAW_FRAMES_OF(glossy, 24);
DRAW_FRAMES(glossy_single_per_channel, 24, {.exit = {.passes = Passes::per_channel}});
DRAW_FRAMES(glossy_single_map, 24, {.exit = {.view_basis = ViewBasis::map}});
// Nearly the most vertices whose matrices a table of 2048 × 16384 texels holds, 532 MB.
DRAW_FRAMES(large_single_vertices, 24, {.size = 4, .ring_count = 560});
DRAW_FRAMES(large_kept_vertices_turning, 24,
            {.sums = Sums::kept, .turning = true, .size = 4, .ring_count = 560});
DRAW_FRAMES(large_uncompressed_vertices, 24,
            {.draw = Draw::uncompressed, .size = 4, .ring_count = 560});

/// Rotating the light and the constants M_i l of all clusters, on all processors.
void change_light(benchmark::State& state) {
  const auto band_count = static_cast<int>(state.range(0));
  const auto row_count = static_cast<int>(state.range(1));
  const auto channel_count = static_cast<int>(state.range(2));
  ClusterConstants constants(
      random_transfer(1, band_count, channel_count, kClusterCount, kComponentCount, row_count),
      exit_layout(row_count, 1));
  const sh::Light light = test_light(band_count);
  float degrees = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(
        constants.evaluate(sh::rotated(light, light_rotation(degrees += 1))).data());
}
BENCHMARK(change_light)
    ->Args({5, 1, 3})
    ->Args({10, 1, 3})
    ->Args({5, 24, 1})
    ->Args({5, 24, 3})
    ->ArgNames({"bands", "rows", "channels"})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

/// The same with the upload to OpenGL and the uncompressed transfer's uniforms, without sums.
void change_light_in_renderer(benchmark::State& state) {
  const gl::HeadlessContext context;
  Renderer renderer;
  renderer.set_model(make_bench_model(static_cast<int>(state.range(0)), 3));
  renderer.set_lighting(lighting_from(test_light(kBandCount)));
  View view;
  view.sums = Sums::every_frame;
  float degrees = 0;
  for (auto _ : state) {
    renderer.set_light_rotation(light_rotation(degrees += 1));
    renderer.prepare(view);
    gl::finish();
  }
}
BENCHMARK(change_light_in_renderer)
    ->Arg(1)
    ->Arg(24)
    ->ArgName("rows")
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc > 1) given_model = argv[1];
  if (argc > 2) given_transfer = argv[2];
  benchmark::RunSpecifiedBenchmarks();
}
