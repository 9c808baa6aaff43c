#include "transfer/matrix_surface.h"

#include <algorithm>

#include "brdf/brdf_matrix.h"
#include "brdf/scene_material.h"
#include "core/log.h"
#include "linalg/product.h"
#include "sh/basis.h"
#include "transfer/reflection.h"

namespace prt::transfer {

namespace {

using linalg::MatrixD;
using linalg::Transpose;

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

std::vector<float> exit_operator(const brdf::Brdf& brdf, const SurfaceOptions& options) {
  const std::vector<int> rows = sh::hemisphere_functions(options.row_count);
  const std::vector<int> columns =
      sh::hemisphere_functions(sh::coefficient_count(options.band_count));
  const auto matrix = brdf::brdf_matrix(brdf, sh::band_count_of(rows), options.band_count);
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

MatrixSurfaces::MatrixSurfaces(const mesh::Scene& scene, const SurfaceOptions& options,
                               int channel_count)
    : scene_(scene), channel_count_(channel_count) {
  const auto rows = static_cast<std::size_t>(options.row_count);
  operator_size_ = rows * static_cast<std::size_t>(sh::coefficient_count(options.band_count));
  const auto brdf = brdf::parse_brdf(options.brdf);
  from_material_ = !brdf;
  if (brdf) {
    surfaces_.push_back({{}, {}, {transposed(exit_operator(*brdf, options), rows)}});
    return;
  }
  for (const mesh::Material& material : scene.materials) {
    if (material.has_unread_textures) {
      log::warning("material \"{}\": textures of roughness, specular and anisotropy are ignored",
                   material.name);
    }
    surfaces_.push_back(surface_of(material, options));
  }
  surfaces_.push_back(surface_of({}, options));
}

// Lobes that are black whatever the base colour is are left out.
MatrixSurfaces::Surface MatrixSurfaces::surface_of(const mesh::Material& from,
                                                   const SurfaceOptions& options) const {
  Surface surface{brdf::metallic_roughness(from), {}, {}};
  const auto lobes = brdf::material_lobes(surface.material);
  const auto colours = brdf::material_colours(surface.material);  // of a white base
  const double rotation = surface.material.has_anisotropy ? from.anisotropy_rotation : 0.0;
  for (std::size_t i = 0; i < brdf::kMaterialLobeCount; ++i) {
    if (colours[i] == brdf::Colour(0)) continue;
    const brdf::Brdf lobe{{{brdf::Colour(1), lobes[i]}}, rotation};
    surface.terms.push_back(
        transposed(exit_operator(lobe, options), static_cast<std::size_t>(options.row_count)));
    surface.lobes.push_back(i);
  }
  return surface;
}

std::vector<Vec3> MatrixSurfaces::term_colours(const Surface& surface, const Vec3& albedo) const {
  if (!from_material_) return {channel_albedo(albedo, channel_count_)};
  brdf::MetallicRoughness material = surface.material;
  material.base_color = brdf::Colour(albedo);
  const auto colours = brdf::material_colours(material);
  std::vector<Vec3> terms;
  for (const std::size_t lobe : surface.lobes) {
    terms.push_back(channel_albedo(Vec3(colours[lobe]), channel_count_));
  }
  return terms;
}

void MatrixSurfaces::at_vertex(const mesh::Primitive& primitive, std::size_t vertex,
                               std::span<float> operators) const {
  const bool shared = !from_material_ || primitive.material < 0;
  const Surface& surface =
      shared ? surfaces_.back() : surfaces_[static_cast<std::size_t>(primitive.material)];
  const Vec3 albedo = mesh::albedo_at_vertex(scene_, primitive, vertex);
  const std::vector<Vec3> colours = term_colours(surface, albedo);
  std::fill(operators.begin(), operators.end(), 0.0f);
  for (int c = 0; c < channel_count_; ++c) {
    float* to = &operators[static_cast<std::size_t>(c) * operator_size_];
    for (std::size_t t = 0; t < surface.terms.size(); ++t) {
      const float colour = colours[t][c];
      const float* from = surface.terms[t].data();
      for (std::size_t i = 0; i < operator_size_; ++i) to[i] += colour * from[i];
    }
  }
}

}  // namespace prt::transfer
