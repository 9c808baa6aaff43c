// Table 1 of [Sloan03] for models of one's own:
//   bench_cpca_table [--components N] a.glb a.transfer.exr [b.glb b.transfer.exr …]
// Points, signal, clusters and vectors, encoding by static and by iterative CPCA, then frames a
// second of the iterative encoding, coherent as prt-compress makes it by default: in one draw call,
// by superclusters, and the signal itself, summed in every frame. Frames are 512x512, without
// antialiasing or background.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "cpca/coherence.h"
#include "cpca/encoder.h"
#include "gl/context.h"
#include "gltf/document.h"
#include "runtime/renderer.h"

namespace {

using namespace prt;

cpca::Options options_of(int component_count) {
  return {.cluster_count = 256, .component_count = component_count, .iterations = 15};
}
constexpr int kSize = 512;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Encoding {
  cpca::Encoding encoding;
  double seconds, squared_error;
};

template <class Encoder>
Encoding encode(Encoder encoder, const signal::TransferSignal& signal,
                const cpca::Options& options) {
  const auto start = std::chrono::steady_clock::now();
  cpca::Encoding encoding = encoder(signal.values, signal.dimension(), options).encoding;
  const double seconds = seconds_since(start);
  const std::vector<double> errors = cpca::point_errors(encoding, signal.values);
  return {std::move(encoding), seconds, std::accumulate(errors.begin(), errors.end(), 0.0)};
}

/// Median of the frames of a second, at least five, after one that fills caches.
double frames_per_second(runtime::Renderer& renderer, const runtime::Model& model,
                         runtime::Draw draw) {
  runtime::View view;
  view.camera = camera::frame(model.bounds, 40, 1);
  view.draw = draw;
  view.sums = runtime::Sums::every_frame;
  const auto frame = [&] {
    const auto start = std::chrono::steady_clock::now();
    renderer.draw(view, kSize, kSize, 1);
    gl::finish();
    return seconds_since(start);
  };
  frame();
  std::vector<double> seconds;
  for (double total = 0.0; total < 1.0 || seconds.size() < 5; total += seconds.back()) {
    seconds.push_back(frame());
  }
  std::sort(seconds.begin(), seconds.end());
  return 1.0 / seconds[seconds.size() / 2];
}

void print_row(const std::filesystem::path& glb, const std::filesystem::path& transfer_file,
               const cpca::Options& options) {
  const mesh::Scene scene = gltf::Document::load(glb).scene();
  const signal::TransferSignal signal = signal::read_transfer(transfer_file);
  signal::check_belongs_to(signal, scene, transfer_file);
  const Encoding by_static = encode(cpca::encode_static, signal, options);
  Encoding by_iterative = encode(cpca::encode_iterative, signal, options);
  const cpca::Coherence coherence = cpca::make_coherent(
      signal.values, scene.indices(), signal.row_count, {}, by_iterative.encoding);
  const gltf::PrecomputedTransfer transfer{.band_count = signal.band_count,
                                           .row_count = signal.row_count,
                                           .channel_count = signal.channel_count,
                                           .brdf = signal.brdf,
                                           .mesh_hash = signal.mesh_hash,
                                           .encoding = std::move(by_iterative.encoding),
                                           .first_clusters = coherence.first_clusters};
  const runtime::Model model = runtime::make_model(scene, transfer, signal);
  runtime::Renderer renderer;
  renderer.set_model(model);
  renderer.set_lighting(runtime::lighting_from(runtime::default_light(signal.band_count)));
  const auto rate = [&](runtime::Draw draw) { return frames_per_second(renderer, model, draw); };
  fmt::print(
      "{:14} {:>7} {:>10} {:>4} {:>3} | {:>7.2f} {:>9.4g} | {:>7.2f} {:>9.4g} |"
      " {:>6.1f} {:>7.1f} {:>12.1f}\n",
      glb.stem().string(), signal.vertex_count(),
      fmt::format("{}x{}x{}", signal.row_count, signal.band_count * signal.band_count,
                  signal.channel_count),
      options.cluster_count, options.component_count, by_static.seconds, by_static.squared_error,
      by_iterative.seconds, by_iterative.squared_error, rate(runtime::Draw::single),
      rate(runtime::Draw::clusters), rate(runtime::Draw::uncompressed));
  std::fflush(stdout);
}

void print_table(const std::vector<std::string>& files, int component_count) {
  const cpca::Options options = options_of(component_count);
  const gl::HeadlessContext context;
  fmt::print("{} threads; {}; {} iterations\n", thread_count(), gl::description(),
             options.iterations);
  fmt::print("{:46}{:^20}{:^20}{:^27}\n", "", "static", "iterative", "frames a second");
  fmt::print("{:14} {:>7} {:>10} {:>4} {:>3} | {:>7} {:>9} | {:>7} {:>9} | {:>6} {:>7} {:>12}\n",
             "model", "m_p", "matrix", "m_c", "n'", "s", "SE", "s", "SE", "single", "by s.c.",
             "uncompressed");
  for (std::size_t i = 0; i < files.size(); i += 2) print_row(files[i], files[i + 1], options);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files(argv + 1, argv + argc);
  int component_count = 8;
  if (files.size() > 2 && files[0] == "--components") {
    component_count = std::atoi(files[1].c_str());
    files.erase(files.begin(), files.begin() + 2);
  }
  if (files.empty() || files.size() % 2 != 0 || component_count < 1) {
    fmt::print(stderr, "usage: bench_cpca_table [--components N] a.glb a.transfer.exr […]\n");
    return 2;
  }
  try {
    print_table(files, component_count);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
