#include "reference/path_tracer.h"

#include <atomic>

#include "core/parallel.h"
#include "core/progress.h"
#include "core/range.h"
#include "core/stopwatch.h"
#include "ray/engine.h"
#include "reference/kept_tiles.h"
#include "reference/surface.h"
#include "reference/tile.h"

namespace prt::reference {

Result trace(const mesh::Scene& scene, const camera::Camera& camera,
             const Illumination& illumination, const Options& options) {
  check_range("image width", options.width, 1, 16384);
  check_range("image height", options.height, 1, 16384);
  check_range("samples per pixel", options.sample_count, 1, 1 << 24);
  check_range("bounces", options.bounce_count, 0, 10000);
  camera::check(camera);

  Result result;
  result.radiance = image::Image(options.width, options.height, 4);
  result.standard_error = image::Image(options.width, options.height, 3);
  result.sample_count =
      (options.sample_count + kReplicateCount - 1) / kReplicateCount * kReplicateCount;
  const Stopwatch build;
  const SurfaceLookup surfaces(scene, options.brdf);
  const auto engine = ray::make_embree_engine(surfaces.triangles());
  result.build_seconds = build.seconds();

  const Stopwatch tracing;
  camera::Camera centred = camera;
  centred.eye = (centred.eye - surfaces.centre()) * surfaces.scale();
  centred.target = (centred.target - surfaces.centre()) * surfaces.scale();
  const Job job{surfaces, *engine, centred, illumination, options, result.sample_count};
  KeptTiles kept(result, options.checkpoint,
                 checkpoint_key(scene, camera, options, result.sample_count));
  const std::vector<std::uint8_t> restored = kept.restore();
  std::atomic<std::uint64_t> rays_cast{0};
  Progress progress("path tracing", kept.count(), "tiles");
  parallel_for(kept.count(), 1, [&](std::size_t i, std::size_t) {
    if (!restored[i]) {
      const Imath::V2i corner = kept.corner(i);
      Tile tile(job, corner.x, corner.y);
      tile.trace();
      tile.write(result);
      rays_cast += tile.rays_cast();
      kept.store(i);
    }
    progress.advance(1);
  });
  result.rays_cast = rays_cast;
  result.trace_seconds = tracing.seconds();
  return result;
}

}  // namespace prt::reference
