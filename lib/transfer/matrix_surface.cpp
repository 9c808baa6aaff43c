#include "transfer/matrix_surface.h"

#include <algorithm>
#include <cmath>

#include "brdf/scene_material.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "linalg/product.h"
#include "sh/basis.h"
#include "transfer/reflection.h"

namespace prt::transfer {

namespace {

using linalg::MatrixD;
using linalg::Transpose;

/// Lobes that some base colour or, with a texture, some metallic gives a colour.
std::vector<std::size_t> lobes_of(const mesh::Material& from) {
  brdf::MetallicRoughness material = brdf::metallic_roughness(from);
  const auto colours = brdf::material_colours(material);
  material.metallic = from.metallic_roughness_image >= 0 ? 0 : material.metallic;
  const auto others = brdf::material_colours(material);
  std::vector<std::size_t> lobes;
  for (std::size_t i = 0; i < brdf::kMaterialLobeCount; ++i) {
    if (colours[i] != brdf::Colour(0) || others[i] != brdf::Colour(0)) lobes.push_back(i);
  }
  return lobes;
}

bool is_microfacet(std::size_t lobe) { return lobe < 2; }

std::vector<float> transposed(const std::vector<float>& matrix, std::size_t row_count) {
  const std::size_t column_count = matrix.size() / row_count;
  std::vector<float> result(matrix.size());
  for (std::size_t r = 0; r < row_count; ++r) {
    for (std::size_t k = 0; k < column_count; ++k) {
      result[k * row_count + r] = matrix[r * column_count + k];
    }
  }
  return result;
}

}  // namespace

std::vector<float> exit_operator(const brdf::BrdfMatrix& matrix, const SurfaceOptions& options) {
  const std::vector<int> rows = sh::hemisphere_functions(options.row_count);
  const std::vector<int> columns =
      sh::hemisphere_functions(sh::coefficient_count(options.band_count));
  const std::size_t m = rows.size(), n = columns.size();
  std::vector<double> b(m * n), left(m * n), both(m * n);
  for (std::size_t i = 0; i < m; ++i) {
    std::copy_n(&matrix.channels[0][static_cast<std::size_t>(rows[i]) * n], n, &b[i * n]);
  }
  std::vector<double> exit = sh::hemisphere_projection(options.projection, rows);
  std::vector<double> incident = sh::hemisphere_projection(options.projection, columns);
  linalg::gemm(1, MatrixD(exit.data(), m, m), Transpose::no, MatrixD(b.data(), m, n), Transpose::no,
               0, MatrixD(left.data(), m, n));
  linalg::gemm(1, MatrixD(left.data(), m, n), Transpose::no, MatrixD(incident.data(), n, n),
               Transpose::no, 0, MatrixD(both.data(), m, n));
  return {both.begin(), both.end()};
}

// Lagrange's polynomials.
RoughnessBlend blend_roughness(double roughness) {
  const double x = roughness * kRoughnessSteps;
  RoughnessBlend blend{std::clamp(static_cast<int>(std::floor(x)) - 1, 0, kRoughnessSteps - 3),
                       {1, 1, 1, 1}};
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      if (k != i) blend.weights[static_cast<std::size_t>(i)] *= (x - blend.first - k) / (i - k);
    }
  }
  return blend;
}

MatrixSurfaces::MatrixSurfaces(const mesh::Scene& scene, const SurfaceOptions& options,
                               int channel_count)
    : scene_(scene),
      options_(options),
      channel_count_(channel_count),
      operator_size_(static_cast<std::size_t>(options.row_count) *
                     sh::row_size(options.band_count)) {
  const Stopwatch watch;
  const auto brdf = brdf::parse_brdf(options.brdf);
  warn_of_missing_tangents(brdf ? &*brdf : nullptr);
  if (brdf) {
    Progress progress("brdf", 1, "matrices");
    named_ = make_operator(*brdf);
    progress.advance(1);
    note_loss(*brdf, options.brdf);
  } else {
    fill_surfaces();
  }
  seconds_ = watch.seconds();
}

/// In mesh::frame_at_vertex the world's axes take the tangent's place.
void MatrixSurfaces::warn_of_missing_tangents(const brdf::Brdf* named) const {
  const auto is_anisotropic = [&](const mesh::Primitive& primitive) {
    if (named) {
      return std::any_of(named->lobes.begin(), named->lobes.end(),
                         [](const auto& term) { return !term.lobe->is_isotropic(); });
    }
    const mesh::Material& material = mesh::material_of(scene_, primitive);
    return material.has_anisotropy && material.anisotropy_strength > 0.0f;
  };
  const auto count =
      std::count_if(scene_.primitives.begin(), scene_.primitives.end(), [&](const auto& primitive) {
        return primitive.mesh.tangents.empty() && is_anisotropic(primitive);
      });
  if (count == 0) return;
  log::warning(
      "{} of {} primitives are anisotropic and have no TANGENT: the world's X axis, flattened onto "
      "the surface, is their direction",
      count, scene_.primitives.size());
}

void MatrixSurfaces::fill_surfaces() {
  find_used();
  const auto material_at = [&](std::size_t i) -> const mesh::Material& {
    return i < scene_.materials.size() ? scene_.materials[i] : mesh::default_material();
  };
  std::size_t matrix_count = 0;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (!surfaces_[i].used) continue;
    for (const std::size_t lobe : lobes_of(material_at(i))) {
      matrix_count += static_cast<std::size_t>(is_microfacet(lobe) ? surfaces_[i].count : 1);
    }
  }
  Progress progress("brdf", matrix_count, "matrices");
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (surfaces_[i].used)
      fill(surfaces_[i], material_at(i), mesh::material_name(scene_, i), progress);
  }
}

void MatrixSurfaces::find_used() {
  surfaces_.resize(scene_.materials.size() + 1);
  for (const mesh::Primitive& primitive : scene_.primitives) {
    Surface& surface = primitive.material < 0
                           ? surfaces_.back()
                           : surfaces_[static_cast<std::size_t>(primitive.material)];
    surface.used = true;
    for (std::size_t v = 0; v < primitive.mesh.vertex_count(); ++v) {
      const double roughness =
          double{mesh::metallic_roughness_at_vertex(scene_, primitive, v).roughness};
      surface.lowest = std::min(surface.lowest, roughness);
      surface.highest = std::max(surface.highest, roughness);
    }
  }
  for (Surface& surface : surfaces_) {
    if (!(surface.lowest < surface.highest)) continue;
    surface.first = blend_roughness(surface.lowest).first;
    surface.count = blend_roughness(surface.highest).first + 4 - surface.first;
  }
}

void MatrixSurfaces::fill(Surface& surface, const mesh::Material& from, const std::string& name,
                          Progress& progress) {
  if (from.has_unread_textures) {
    log::warning("{}: textures of specular and anisotropy are ignored", name);
  }
  surface.material = brdf::metallic_roughness(from);
  brdf::MetallicRoughness material = surface.material;
  for (const std::size_t lobe : lobes_of(from)) {
    Term term{lobe, {}};
    for (int k = 0; k < (is_microfacet(lobe) ? surface.count : 1); ++k) {
      material.roughness = surface.count > 1
                               ? static_cast<double>(surface.first + k) / kRoughnessSteps
                               : surface.lowest;
      term.operators.push_back(
          make_operator({{{brdf::Colour(1), brdf::material_lobes(material)[lobe]}},
                         material.has_anisotropy ? material.anisotropy_rotation : 0.0}));
      progress.advance(1);
    }
    surface.terms.push_back(std::move(term));
  }
  material.roughness = surface.lowest;
  material.base_color =
      brdf::Colour(double{from.base_color.x}, double{from.base_color.y}, double{from.base_color.z});
  note_loss(brdf::make_brdf(material), name);
}

std::vector<float> MatrixSurfaces::make_operator(const brdf::Brdf& brdf) const {
  const int row_bands = sh::band_count_of(sh::hemisphere_functions(options_.row_count));
  return transposed(
      exit_operator(brdf::brdf_matrix(brdf, row_bands, options_.band_count), options_),
      static_cast<std::size_t>(options_.row_count));
}

void MatrixSurfaces::note_loss(const brdf::Brdf& brdf, const std::string& name) {
  const int row_bands = sh::band_count_of(sh::hemisphere_functions(options_.row_count));
  const brdf::BrdfMatrix matrix = brdf::brdf_matrix(brdf, row_bands, options_.band_count);
  brdf::warn_of_losses(matrix, name);
  losses_.push_back({name, matrix.loss, matrix.error});
}

void MatrixSurfaces::at_vertex(const mesh::Primitive& primitive, std::size_t vertex,
                               std::span<float> operators) const {
  std::fill(operators.begin(), operators.end(), 0.0f);
  if (named_.empty()) return add_material(primitive, vertex, operators);
  const Vec3 albedo = mesh::albedo_at_vertex(scene_, primitive, vertex);
  add(channel_albedo(albedo, channel_count_), named_, operators);
}

void MatrixSurfaces::add_material(const mesh::Primitive& primitive, std::size_t vertex,
                                  std::span<float> operators) const {
  const Surface& surface = primitive.material < 0
                               ? surfaces_.back()
                               : surfaces_[static_cast<std::size_t>(primitive.material)];
  const auto [metallic, roughness] = mesh::metallic_roughness_at_vertex(scene_, primitive, vertex);
  brdf::MetallicRoughness material = surface.material;
  material.metallic = double{metallic};
  material.base_color = brdf::Colour(mesh::albedo_at_vertex(scene_, primitive, vertex));
  const auto colours = brdf::material_colours(material);
  const RoughnessBlend blend = blend_roughness(double{roughness});
  for (const Term& term : surface.terms) {
    const Vec3 colour = channel_albedo(Vec3(colours[term.lobe]), channel_count_);
    if (term.operators.size() == 1) {
      add(colour, term.operators[0], operators);
      continue;
    }
    for (std::size_t k = 0; k < blend.weights.size(); ++k) {
      add(colour * static_cast<float>(blend.weights[k]),
          term.operators[static_cast<std::size_t>(blend.first - surface.first) + k], operators);
    }
  }
}

void MatrixSurfaces::add(const Vec3& factor, const std::vector<float>& from,
                         std::span<float> operators) const {
  for (int c = 0; c < channel_count_; ++c) {
    float* to = &operators[static_cast<std::size_t>(c) * operator_size_];
    for (std::size_t i = 0; i < operator_size_; ++i) to[i] += factor[c] * from[i];
  }
}

}  // namespace prt::transfer
