#include "transfer/matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "brdf/brdf_matrix.h"
#include "brdf/scene_material.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "linalg/product.h"
#include "mesh/frame.h"
#include "sh/basis.h"
#include "sh/rotation.h"
#include "transfer/channels.h"
#include "transfer/limits.h"
#include "transfer/matrix_visibility.h"
#include "transfer/reflection.h"

namespace prt::transfer {

namespace {

using linalg::ConstMatrixF;
using linalg::MatrixD;
using linalg::MatrixF;
using linalg::Transpose;

std::size_t size_of(int band_count) {
  return static_cast<std::size_t>(sh::coefficient_count(band_count));
}

void check_options(const MatrixOptions& options) {
  check_range("band count of a transfer matrix", options.band_count, 1, kMaxMatrixBandCount);
  check_range("ray count", options.ray_count, 1, kMaxRayCount);
  sh::hemisphere_functions(options.row_count);
}

bool has_coloured_specular(const mesh::Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const auto& m) {
    return m.specular_color.x != m.specular_color.y || m.specular_color.y != m.specular_color.z;
  });
}

signal::TransferSignal make_header(const mesh::Scene& scene, const MatrixOptions& options) {
  signal::TransferSignal header;
  header.band_count = options.band_count;
  header.row_count = options.row_count;
  header.channel_count = choose_channel_count(scene, options.channels, false);
  if (options.channels == ChannelMode::automatic && options.brdf == "from-material" &&
      has_coloured_specular(scene)) {
    header.channel_count = 3;
  }
  if (header.dimension() > signal::kMaxDimension) {
    throw Error(ErrorKind::usage, "transfer matrices too large for a file",
                {.found = fmt::format("{} × {} × {} coefficients", header.channel_count,
                                      header.row_count, size_of(header.band_count)),
                 .expected = fmt::format("at most {}", signal::kMaxDimension),
                 .advice = "Ask for fewer with --bands or --rows."});
  }
  header.brdf = options.brdf;
  header.seed = options.seed;
  header.ray_count = options.shadowed ? options.ray_count : 0;
  header.tool_version = PRTKIT_VERSION;
  header.mesh_hash = mesh::mesh_hash(scene);
  for (const mesh::Primitive& primitive : scene.primitives) {
    header.blocks.push_back({primitive.name, primitive.mesh.vertex_count()});
  }
  return header;
}

// Lobes that are black whatever the base colour is are left out.
SurfaceOperator operator_of(const mesh::Material& from, const MatrixOptions& options) {
  SurfaceOperator surface{0, {}, true, brdf::metallic_roughness(from), {}};
  const auto lobes = brdf::material_lobes(surface.material);
  const auto colours = brdf::material_colours(surface.material);  // of a white base
  const double rotation = surface.material.has_anisotropy ? from.anisotropy_rotation : 0.0;
  for (std::size_t i = 0; i < brdf::kMaterialLobeCount; ++i) {
    if (colours[i] == brdf::Colour(0)) continue;
    const brdf::Brdf lobe{{{brdf::Colour(1), lobes[i]}}, rotation};
    const std::vector<float> values =
        exit_operator(lobe, options.row_count, options.band_count, options.projection);
    surface.values.insert(surface.values.end(), values.begin(), values.end());
    surface.lobes.push_back(i);
  }
  surface.term_count = surface.lobes.size();
  return surface;
}

std::vector<SurfaceOperator> make_surfaces(const mesh::Scene& scene, const MatrixOptions& options) {
  std::vector<SurfaceOperator> surfaces;
  const auto brdf = brdf::parse_brdf(options.brdf);
  if (brdf) {
    surfaces.assign(
        scene.materials.size() + 1,
        {1, exit_operator(*brdf, options.row_count, options.band_count, options.projection)});
    return surfaces;
  }
  for (const mesh::Material& material : scene.materials) {
    if (material.has_unread_textures) {
      log::warning("material \"{}\": textures of roughness, specular and anisotropy are ignored",
                   material.name);
    }
    surfaces.push_back(operator_of(material, options));
  }
  surfaces.push_back(operator_of({}, options));
  return surfaces;
}

/// Colours of a surface's terms at a vertex, as the transfer sees them.
std::vector<Vec3> term_colours(const SurfaceOperator& surface, const Vec3& albedo,
                               int channel_count) {
  if (!surface.from_material) return {channel_albedo(albedo, channel_count)};
  brdf::MetallicRoughness material = surface.material;
  material.base_color = brdf::Colour(albedo);
  const auto colours = brdf::material_colours(material);
  std::vector<Vec3> terms;
  for (const std::size_t lobe : surface.lobes) {
    terms.push_back(channel_albedo(Vec3(colours[lobe]), channel_count));
  }
  return terms;
}

}  // namespace

std::vector<float> exit_operator(const brdf::Brdf& brdf, int row_count, int band_count,
                                 sh::HemisphereProjection projection) {
  const std::vector<int> rows = sh::hemisphere_functions(row_count);
  const std::vector<int> columns = sh::hemisphere_functions(sh::coefficient_count(band_count));
  const auto matrix = brdf::brdf_matrix(brdf, sh::band_count_of(rows), band_count);
  const std::size_t m = rows.size(), n = columns.size();
  std::vector<double> b(m * n), left(m * n), both(m * n);
  for (std::size_t i = 0; i < m; ++i) {
    std::copy_n(&matrix.channels[0][static_cast<std::size_t>(rows[i]) * n], n, &b[i * n]);
  }
  std::vector<double> exit = sh::hemisphere_projection(projection, rows);
  std::vector<double> incident = sh::hemisphere_projection(projection, columns);
  linalg::gemm(1, MatrixD(exit.data(), m, m), Transpose::no, MatrixD(b.data(), m, n), Transpose::no,
               0, MatrixD(left.data(), m, n));
  linalg::gemm(1, MatrixD(left.data(), m, n), Transpose::no, MatrixD(incident.data(), n, n),
               Transpose::no, 0, MatrixD(both.data(), m, n));
  return {both.begin(), both.end()};
}

struct MatrixTransfer::Run {
  std::size_t first, count;
  const mesh::Primitive& primitive;
  std::size_t local;  ///< number of the first in the primitive
};

MatrixTransfer::MatrixTransfer(const mesh::Scene& scene, const MatrixOptions& options,
                               DiffuseStats& stats)
    : scene_(scene), vertex_offsets_(scene.vertex_offsets()) {
  check_options(options);
  stats = {};
  header_ = make_header(scene, options);
  surfaces_ = make_surfaces(scene, options);
  triple_ = triple_products(options.band_count);
  const auto start = std::chrono::steady_clock::now();
  const SceneIndex index(scene);
  stats.build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  visibility_ = compute_visibility(
      index, {2 * options.band_count - 1, options.ray_count, options.shadowed, options.seed},
      stats);
}

void MatrixTransfer::compute(std::size_t first, std::size_t count, std::span<float> values) const {
  const auto dimension = static_cast<std::size_t>(header_.dimension());
  parallel_for(count, kVertexBlock, [&](std::size_t begin, std::size_t end) {
    while (begin < end) {
      const std::size_t vertex = first + begin;
      const auto next = std::upper_bound(vertex_offsets_.begin(), vertex_offsets_.end(), vertex);
      const auto number = static_cast<std::size_t>(next - vertex_offsets_.begin()) - 1;
      const Run run{vertex, std::min(end - begin, *next - vertex), scene_.primitives[number],
                    vertex - vertex_offsets_[number]};
      compute_run(run, &values[begin * dimension]);
      begin += run.count;
    }
  });
}

// Vertices side by side, so that the two large products are of matrices, not of vectors.
void MatrixTransfer::compute_run(const Run& run, float* values) const {
  const std::size_t n = size_of(header_.band_count), size = n * n;
  const std::size_t m = size_of(2 * header_.band_count - 1);
  const int material = run.primitive.material;
  const SurfaceOperator& surface =
      material < 0 ? surfaces_.back() : surfaces_[static_cast<std::size_t>(material)];
  const std::size_t rows = surface.term_count * static_cast<std::size_t>(header_.row_count);
  const std::size_t width = run.count * n;
  std::vector<float> moments(run.count * size), turned(n * width), exit(rows * width);
  linalg::gemm(1.0f, ConstMatrixF(&visibility_[run.first * m], run.count, m), Transpose::no,
               ConstMatrixF(triple_.data(), m, size), Transpose::no, 0.0f,
               MatrixF(moments.data(), run.count, size));
  for (std::size_t v = 0; v < run.count; ++v) turn(run, v, &moments[v * size], &turned[v * n]);
  linalg::gemm(1.0f, ConstMatrixF(surface.values.data(), rows, n), Transpose::no,
               ConstMatrixF(turned.data(), n, width), Transpose::no, 0.0f,
               MatrixF(exit.data(), rows, width));
  store(run, surface, exit, values);
}

// R_p T_p, in a left-handed frame with the signs that a mirrored y gives functions of sines.
void MatrixTransfer::turn(const Run& run, std::size_t number, const float* moments,
                          float* turned) const {
  const auto [x, y, z] = mesh::frame_at_vertex(run.primitive.mesh, run.local + number);
  const Vec3 right = z.cross(x);
  const bool mirrored = right.dot(y) < 0.0f;
  const Matrix4 local_from_world(x.x, right.x, z.x, 0, x.y, right.y, z.y, 0, x.z, right.z, z.z, 0,
                                 0, 0, 0, 1);
  const sh::Rotation rotation(header_.band_count, local_from_world);
  const std::size_t n = size_of(header_.band_count);
  for (int l = 0; l < header_.band_count; ++l) {
    for (int i = -l; i <= l; ++i) {
      float* row = turned + static_cast<std::size_t>(sh::coefficient_index(l, i)) * run.count * n;
      std::fill_n(row, n, 0.0f);
      for (int k = -l; k <= l; ++k) {
        const auto sign = mirrored && i < 0 ? -1.0f : 1.0f;
        const float factor = sign * static_cast<float>(rotation.at(l, i, k));
        const float* from = moments + static_cast<std::size_t>(sh::coefficient_index(l, k)) * n;
        for (std::size_t j = 0; j < n; ++j) row[j] += factor * from[j];
      }
    }
  }
}

void MatrixTransfer::store(const Run& run, const SurfaceOperator& surface,
                           const std::vector<float>& exit, float* values) const {
  const std::size_t n = size_of(header_.band_count);
  const auto rows = static_cast<std::size_t>(header_.row_count);
  for (std::size_t v = 0; v < run.count; ++v) {
    const Vec3 albedo = mesh::albedo_at_vertex(scene_, run.primitive, run.local + v);
    const std::vector<Vec3> colours = term_colours(surface, albedo, header_.channel_count);
    for (int c = 0; c < header_.channel_count; ++c) {
      for (std::size_t r = 0; r < rows; ++r, values += n) {
        std::fill_n(values, n, 0.0f);
        for (std::size_t t = 0; t < surface.term_count; ++t) {
          const float* from = &exit[((t * rows + r) * run.count + v) * n];
          for (std::size_t j = 0; j < n; ++j) values[j] += colours[t][c] * from[j];
        }
      }
    }
  }
}

signal::TransferSignal compute_matrices(const mesh::Scene& scene, const MatrixOptions& options,
                                        DiffuseStats& stats) {
  const MatrixTransfer transfer(scene, options, stats);
  signal::TransferSignal signal = transfer.header();
  signal.values.resize(signal.vertex_count() * static_cast<std::size_t>(signal.dimension()));
  transfer.compute(0, signal.vertex_count(), signal.values);
  return signal;
}

}  // namespace prt::transfer
