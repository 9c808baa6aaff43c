#include "reference/tile.h"

#include <algorithm>

#include "reference/sampler.h"

namespace prt::reference {

namespace {

using Vec3d = Imath::V3d;

// Pairs of dimensions of a path: the pixel's, then three for each of its vertices.
constexpr std::uint32_t kPixelPair = 0;
std::uint32_t scatter_pair(int bounce) { return 1 + 3 * static_cast<std::uint32_t>(bounce); }
std::uint32_t light_pair(int bounce) { return 2 + 3 * static_cast<std::uint32_t>(bounce); }
std::uint32_t lobe_pair(int bounce) { return 3 + 3 * static_cast<std::uint32_t>(bounce); }

}  // namespace

Tile::Tile(const Job& job, int x, int y)
    : job_(job),
      x_(x),
      y_(y),
      width_(std::min(kTileSize, job.options.width - x)),
      height_(std::min(kTileSize, job.options.height - y)),
      pixels_(static_cast<std::size_t>(pixel_count())),
      radiance_(pixels_.size() * kBatchSampleCount) {
  const auto seed = static_cast<std::uint32_t>(job.options.seed ^ (job.options.seed >> 32));
  for (int i = 0; i < pixel_count(); ++i) {
    const auto column = static_cast<std::uint32_t>(x_ + i % width_);
    const auto row = static_cast<std::uint32_t>(y_ + i / width_);
    const std::uint32_t pixel_seed = hash_combine(hash_combine(seed, column), row);
    for (std::uint32_t r = 0; r < kReplicateCount; ++r) {
      seeds_.push_back(hash_combine(pixel_seed, r));
    }
  }
}

Vec2 Tile::point(std::uint32_t slot, std::uint32_t pair) const {
  const auto sample = static_cast<std::uint32_t>(first_sample_) + slot % kBatchSampleCount;
  const std::uint32_t seed =
      seeds_[slot / kBatchSampleCount * kReplicateCount + sample % kReplicateCount];
  return sobol_point(sample / kReplicateCount, hash_combine(seed, pair));
}

void Tile::trace() {
  const bool centers = job_.options.filter == PixelFilter::center;
  for (; first_sample_ < job_.sample_count; first_sample_ += kBatchSampleCount) {
    batch_sample_count_ = std::min(kBatchSampleCount, job_.sample_count - first_sample_);
    std::fill(radiance_.begin(), radiance_.end(), Vec3(0.0f));
    if (!centers) shoot(batch_sample_count_);
    if (centers && first_sample_ == 0) shoot(1);
    start_paths();
    for (int bounce = 0; bounce <= job_.options.bounce_count; ++bounce) scatter(bounce);
    add_batch();
  }
}

// Camera rays: all samples of the batch, or one a pixel, which then stands for all its samples.
void Tile::shoot(int samples_per_pixel) {
  const bool centers = job_.options.filter == PixelFilter::center;
  rays_.clear();
  starts_.clear();
  escapes_.clear();
  for (int i = 0; i < pixel_count(); ++i) {
    for (int s = 0; s < samples_per_pixel; ++s) {
      const auto slot = static_cast<std::uint32_t>(i * kBatchSampleCount + s);
      const Vec2 offset = centers ? Vec2(0.5f, 0.5f) : point(slot, kPixelPair);
      const float x = static_cast<float>(x_ + i % width_) + offset.x;
      const float y = static_cast<float>(y_ + i / width_) + offset.y;
      rays_.push_back(
          {job_.camera.eye, 0.0f,
           job_.camera.ray_direction(2.0f * x / static_cast<float>(job_.options.width) - 1.0f,
                                     1.0f - 2.0f * y / static_cast<float>(job_.options.height))});
    }
  }
  hits_.resize(rays_.size());
  job_.engine.closest_hit(rays_, hits_);
  rays_cast_ += rays_.size();
  const int weight = centers ? job_.sample_count : 1;
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    const auto per_pixel = static_cast<std::size_t>(samples_per_pixel);
    const std::size_t pixel = i / per_pixel;
    const auto slot = static_cast<std::uint32_t>(pixel * kBatchSampleCount + i % per_pixel);
    if (hits_[i].triangle == ray::kNoHit) {
      if (job_.options.background) escapes_.add(rays_[i].direction, Vec3(1.0f), slot);
      continue;
    }
    pixels_[pixel].covered += weight;
    if (const auto vertex = job_.surfaces.surface_at(hits_[i], rays_[i].direction)) {
      starts_.push_back({*vertex, Vec3(1.0f), slot});
    }
  }
  add_background();
}

// A centre's background is one value for all samples: it goes straight into the sums.
void Tile::add_background() {
  escapes_.radiance.resize(escapes_.directions.size());
  job_.illumination.radiance(escapes_.directions, escapes_.radiance);
  for (std::size_t i = 0; i < escapes_.slots.size(); ++i) {
    if (job_.options.filter == PixelFilter::box) {
      radiance_[escapes_.slots[i]] = escapes_.radiance[i];
      continue;
    }
    for (Vec3d& sum : pixels_[escapes_.slots[i] / kBatchSampleCount].sums) {
      sum += Vec3d(escapes_.radiance[i]) * (job_.sample_count / kReplicateCount);
    }
  }
}

void Tile::start_paths() {
  if (job_.options.filter == PixelFilter::box) {
    paths_ = starts_;
    return;
  }
  paths_.clear();
  for (Path path : starts_) {
    for (int s = 0; s < batch_sample_count_; ++s, ++path.slot) paths_.push_back(path);
  }
}

// One more ray from every path: what escapes brings light, what hits goes on.
void Tile::scatter(int bounce) {
  if (paths_.empty()) return;
  if (job_.illumination.is_peaked()) scatter_to_light(bounce);
  sample_brdfs(bounce);
  rays_cast_ += rays_.size();
  blocked_.resize(rays_.size());
  const bool last = bounce == job_.options.bounce_count;
  if (last) {
    job_.engine.occluded(rays_, blocked_);
  } else {
    hits_.resize(rays_.size());
    job_.engine.closest_hit(rays_, hits_);
    for (std::size_t i = 0; i < hits_.size(); ++i) blocked_[i] = hits_[i].triangle != ray::kNoHit;
  }
  escapes_.clear();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (blocked_[i]) continue;
    Vec3 weight = paths_[i].throughput;
    if (job_.illumination.is_peaked()) {  // the balance heuristic
      const float pdf = paths_[i].pdf;
      weight *= pdf / (pdf + job_.illumination.pdf(rays_[i].direction));
    }
    escapes_.add(rays_[i].direction, weight, paths_[i].slot);
  }
  gather();
  if (last) {
    paths_.clear();
  } else {
    follow_hits();
  }
}

// A ray for every path, whose throughput it multiplies by f cos / pdf. Paths end that reflect
// nothing.
void Tile::sample_brdfs(int bounce) {
  rays_.clear();
  std::size_t kept = 0;
  for (Path path : paths_) {
    const SurfacePoint& vertex = path.vertex;
    const PointBrdf brdf = vertex.brdf();
    const auto terms = brdf.terms();
    const brdf::Direction eye(vertex.eye);
    const Vec2 u = point(path.slot, scatter_pair(bounce));
    const float u0 = terms.size() > 1 ? point(path.slot, lobe_pair(bounce)).x : 0.0f;
    const brdf::Direction light = brdf::sample(terms, eye, double{u0}, double{u.x}, double{u.y});
    const brdf::Colour value = brdf::evaluate(terms, light, eye);
    if (value == brdf::Colour(0)) continue;
    const double pdf = brdf::pdf(terms, light, eye);
    path.throughput *= Vec3(value * (light.z / pdf));
    path.pdf = static_cast<float>(pdf);
    rays_.push_back({vertex.origin, 0.0f, vertex.world_from_local(Vec3(light)).normalized()});
    paths_[kept++] = path;
  }
  paths_.resize(kept);
}

// The other strategy of the balance heuristic: directions drawn from the light.
void Tile::scatter_to_light(int bounce) {
  rays_.clear();
  escapes_.clear();
  for (const Path& path : paths_) {
    const Illumination::Sample sample =
        job_.illumination.sample(point(path.slot, light_pair(bounce)));
    const SurfacePoint& vertex = path.vertex;
    const brdf::Direction light(vertex.local_from_world(sample.direction)), eye(vertex.eye);
    if (light.z <= 0.0 || sample.pdf <= 0.0f) continue;
    const PointBrdf brdf = vertex.brdf();
    const brdf::Colour value = brdf::evaluate(brdf.terms(), light, eye);
    if (value == brdf::Colour(0)) continue;
    const double pdf = brdf::pdf(brdf.terms(), light, eye);
    // f L cos / p_light * p_light / (p_light + p_brdf)
    const Vec3 weight(value * (light.z / (double{sample.pdf} + pdf)));
    rays_.push_back({vertex.origin, 0.0f, sample.direction});
    escapes_.add(sample.direction, path.throughput * weight, path.slot);
  }
  rays_cast_ += rays_.size();
  blocked_.resize(rays_.size());
  job_.engine.occluded(rays_, blocked_);
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (blocked_[i]) escapes_.weights[i] = Vec3(0.0f);
  }
  gather();
}

void Tile::follow_hits() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (!blocked_[i]) continue;
    const auto vertex = job_.surfaces.surface_at(hits_[i], rays_[i].direction);
    if (vertex) paths_[kept++] = {*vertex, paths_[i].throughput, paths_[i].slot};
  }
  paths_.resize(kept);
}

void Tile::gather() {
  escapes_.radiance.resize(escapes_.directions.size());
  job_.illumination.radiance(escapes_.directions, escapes_.radiance);
  for (std::size_t i = 0; i < escapes_.slots.size(); ++i) {
    radiance_[escapes_.slots[i]] += escapes_.weights[i] * escapes_.radiance[i];
  }
}

void Tile::add_batch() {
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    for (int s = 0; s < batch_sample_count_; ++s) {
      const auto replicate = static_cast<std::size_t>((first_sample_ + s) % kReplicateCount);
      pixels_[i].sums[replicate] +=
          Vec3d(radiance_[i * kBatchSampleCount + static_cast<std::size_t>(s)]);
    }
  }
}

void Tile::write(Result& result) const {
  for (int i = 0; i < pixel_count(); ++i) {
    const Pixel& pixel = pixels_[static_cast<std::size_t>(i)];
    float* rgba = result.radiance.at(x_ + i % width_, y_ + i / width_);
    float* error = result.standard_error.at(x_ + i % width_, y_ + i / width_);
    for (int c = 0; c < 3; ++c) {
      double mean = 0.0, square = 0.0;
      for (const Vec3d& sum : pixel.sums) mean += sum[c] / job_.sample_count;
      for (const Vec3d& sum : pixel.sums) {
        const double difference = sum[c] * kReplicateCount / job_.sample_count - mean;
        square += difference * difference;
      }
      rgba[c] = static_cast<float>(mean);
      error[c] = static_cast<float>(std::sqrt(square / (kReplicateCount * (kReplicateCount - 1))));
    }
    rgba[3] = static_cast<float>(pixel.covered) / static_cast<float>(job_.sample_count);
  }
}

}  // namespace prt::reference
