// Ground truth for the bakes: an unbiased path tracer with their model of light.
//
// The model. Surfaces reflect by a BRDF of lib/brdf about the interpolated vertex normal, which is
// both the middle of the hemisphere that light comes from and the axis of its cosine; an
// anisotropic BRDF is turned by the interpolated frames of the vertices (mesh/frame.h). Rays leave
// the flat triangle on the side of that normal; the ones that dip below the triangle's plane hit
// it, as in the bake they hit a vertex's own faces. Where the eye is below the horizon of the
// interpolated normal, at outlines, the surface is seen as from its horizon. Anything in the way
// blocks, seen from the front or from behind. What is hit from the front reflects; what is hit from
// behind reflects nothing (black), even where the material is double-sided: a vertex has one normal
// and transfer knows its side alone. `bounce_count` interreflections are followed, exactly: 0 is
// direct light only, and no path is cut short at random.
//
// The estimator. Directions are drawn from the BRDF, one ray a vertex of the path. Peaked lights
// (whole maps) are sampled as well, and both are combined by the balance heuristic [Veach 1997
// §9.2]. Band-limited light may be negative and is never clamped. Samples of a pixel are two
// independently scrambled Sobol' sets; how far their means lie apart gives the standard error,
// unbiased in spite of stratification.
#pragma once

#include <cstdint>
#include <string>

#include "camera/camera.h"
#include "core/checkpoint.h"
#include "image/image.h"
#include "mesh/scene.h"
#include "reference/illumination.h"

namespace prt::reference {

/// Independent sets of samples in every pixel. More would make the standard error of a single pixel
/// surer, but the mean noisier: larger sets are better stratified. Sums over many pixels are sure
/// enough with two.
constexpr int kReplicateCount = 2;

enum class PixelFilter {
  center,  ///< what the centre of the pixel sees: comparable to a rasteriser without antialiasing
  box,     ///< the mean over the pixel's square
};

struct Options {
  std::string brdf = "lambert";     ///< by brdf::kBrdfSyntax; its factor is the albedo
  int width = 1024, height = 1024;  ///< pixels; camera.aspect should be their ratio
  int sample_count = 256;           ///< paths a pixel; rounded up to a multiple of kReplicateCount
  int bounce_count = 2;             ///< interreflections
  std::uint64_t seed = 1;
  PixelFilter filter = PixelFilter::center;
  bool background = false;         ///< show the light where nothing is hit, instead of black
  CheckpointOptions checkpoint{};  ///< where to keep finished tiles, for a run that continues this
  std::string illumination_key = {};  ///< tells one light from another there
};

struct Result {
  image::Image radiance;        ///< RGBA, linear; alpha is coverage, and RGB is premultiplied by it
  image::Image standard_error;  ///< RGB, of `radiance`: one standard deviation of its mean
  int sample_count = 0;         ///< paths a pixel, as rounded
  std::uint64_t rays_cast = 0;  ///< in this run
  double resumed_share = 0.0;   ///< of the tiles, traced by an interrupted run before this one
  double build_seconds = 0.0;   ///< making the ray engine
  double trace_seconds = 0.0;
};

/// The same image for the same arguments, whatever the number of threads. Scratch memory is a few
/// megabytes a thread beside the scene's triangles and the two images. Throws Error (usage) when a
/// count or size is out of range or there is no such BRDF, Error (bad_input) from the ray engine.
Result trace(const mesh::Scene& scene, const camera::Camera& camera,
             const Illumination& illumination, const Options& options);

}  // namespace prt::reference
