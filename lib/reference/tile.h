// The work of the path tracer: one square of the image, on one thread, in batches of paths.
#pragma once

#include <array>
#include <vector>

#include "ray/engine.h"
#include "reference/path_tracer.h"
#include "reference/surface.h"

namespace prt::reference {

constexpr int kTileSize = 32;
constexpr int kBatchSampleCount = 16;  ///< samples of each pixel of a tile that are traced together

/// What all tiles share.
struct Job {
  const SurfaceLookup& surfaces;
  const ray::Engine& engine;
  const camera::Camera& camera;  // relative to the centre of the surfaces
  const Illumination& illumination;
  const Options& options;
  int sample_count;
};

struct Path {
  SurfacePoint vertex;  // the one it has reached
  Vec3 throughput;      // what its light counts for the pixel
  std::uint32_t slot;   // pixel of the tile * kBatchSampleCount + sample of the batch
  float pdf = 0.0f;     // of the direction it leaves `vertex` in, once scattered
};

// Directions that escaped, and by how much each counts for its path.
struct Escapes {
  std::vector<Vec3> directions, weights, radiance;
  std::vector<std::uint32_t> slots;

  void clear() {
    directions.clear();
    weights.clear();
    slots.clear();
  }
  void add(const Vec3& direction, const Vec3& weight, std::uint32_t slot) {
    directions.push_back(direction);
    weights.push_back(weight);
    slots.push_back(slot);
  }
};

/// All samples of one tile of the image, a batch at a time: the paths of a batch advance together,
/// so that rays are traced and light is evaluated in long spans.
class Tile {
 public:
  Tile(const Job& job, int x, int y);
  void trace();
  void write(Result& result) const;
  std::uint64_t rays_cast() const { return rays_cast_; }

 private:
  struct Pixel {
    std::array<Imath::V3d, kReplicateCount> sums;  // of radiance, over the samples of a replicate
    int covered = 0;                               // camera rays that hit
  };

  int pixel_count() const { return width_ * height_; }
  Vec2 point(std::uint32_t slot, std::uint32_t pair) const;
  void shoot(int samples_per_pixel);
  void add_background();
  void start_paths();
  void scatter(int bounce);
  void sample_brdfs(int bounce);
  void scatter_to_light(int bounce);
  void follow_hits();
  void gather();
  void add_batch();

  const Job& job_;
  int x_, y_, width_, height_;
  int first_sample_ = 0;        // of the batch
  int batch_sample_count_ = 0;  // of the batch
  std::uint64_t rays_cast_ = 0;
  std::vector<Pixel> pixels_;
  std::vector<std::uint32_t> seeds_;  // pixel * kReplicateCount + replicate
  std::vector<Path> starts_;          // camera rays that hit something that reflects
  std::vector<Path> paths_;
  std::vector<ray::Ray> rays_;
  std::vector<ray::Hit> hits_;
  std::vector<std::uint8_t> blocked_;
  Escapes escapes_;
  std::vector<Vec3> radiance_;  // of each slot of the batch
};

}  // namespace prt::reference
