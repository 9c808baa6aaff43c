#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "gltf/document.h"
#include "gltf/precomputed_transfer.h"
#include "inspect/inspection.h"
#include "inspect/schema.h"
#include "inspect/statistics.h"
#include "mesh/scene.h"
#include "sh/basis.h"
#include "sh/radiance_metric.h"

namespace prt::inspect {

namespace {

using gltf::kTransferExtension;

Json describe(const mesh::Scene& scene, const mesh::Primitive& primitive) {
  const mesh::TriangleMesh& mesh = primitive.mesh;
  Vec3 low(INFINITY), high(-INFINITY);
  for (const Vec3& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  Json json = {{"name", primitive.name},
               {"mesh", primitive.mesh_index},
               {"primitive", primitive.primitive_index},
               {"vertex_count", mesh.vertex_count()},
               {"triangle_count", mesh.triangle_count()},
               {"bounds_min", to_json(low)},
               {"bounds_max", to_json(high)},
               {"texcoords", !mesh.texcoords.empty()},
               {"colors", !mesh.colors.empty()}};
  if (primitive.material >= 0) {
    const auto& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    json["base_color"] = {material.base_color.x, material.base_color.y, material.base_color.z};
    json["base_color_texture"] = material.base_color_image >= 0;
    json["double_sided"] = material.double_sided;
  }
  return json;
}

// Vectors of a cluster, in coordinates in which they should be orthonormal, with weights other than
// floats orthogonal; a cluster of fewer points than components pads with zeros.
double orthonormality_error(std::span<const float> vectors, std::size_t dimension, int count,
                            bool unit_length) {
  const auto dot = [&](int i, int j) {
    const auto a = vectors.subspan(static_cast<std::size_t>(i) * dimension, dimension);
    const auto b = vectors.subspan(static_cast<std::size_t>(j) * dimension, dimension);
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  double worst = 0.0;
  for (int i = 0; i < count; ++i) {
    const double square = dot(i, i);
    if (square == 0.0) continue;
    if (unit_length) worst = std::max(worst, std::abs(square - 1.0));
    for (int j = 0; j < i; ++j) {
      const double product = dot(i, j);
      if (product != 0.0)
        worst = std::max(worst, std::abs(product) / std::sqrt(square * dot(j, j)));
    }
  }
  return worst;
}

double orthonormality_error(const gltf::PrecomputedTransfer& transfer) {
  const cpca::Encoding& encoding = transfer.encoding;
  std::vector<float> bases = encoding.bases;
  sh::RadianceMetric(transfer.row_count, sh::row_size(transfer.band_count)).apply(bases);
  const bool unit_length = transfer.weight_format == cpca::WeightFormat::float32;
  const auto dimension = static_cast<std::size_t>(encoding.dimension);
  const std::size_t cluster_size = static_cast<std::size_t>(encoding.component_count) * dimension;
  double worst = 0.0;
  for (int k = 0; k < encoding.cluster_count; ++k) {
    const auto vectors =
        std::span(bases).subspan(static_cast<std::size_t>(k) * cluster_size, cluster_size);
    worst = std::max(worst, orthonormality_error(vectors, dimension, encoding.component_count_of(k),
                                                 unit_length));
  }
  return worst;
}

std::vector<double> cluster_sizes(const cpca::Encoding& encoding) {
  std::vector<double> sizes(static_cast<std::size_t>(encoding.cluster_count));
  for (const std::uint32_t cluster : encoding.cluster_of_point) sizes[cluster] += 1.0;
  return sizes;
}

Json describe_sizes(std::vector<double> sizes) {
  double sum = 0.0;
  for (const double size : sizes) sum += size;
  return {{"min", percentile(sizes, 0.0)},
          {"median", percentile(sizes, 0.5)},
          {"mean", sum / static_cast<double>(sizes.size())},
          {"max", percentile(sizes, 1.0)}};
}

// As the extension stores it, against the signal as float32.
Json describe_bytes(const gltf::PrecomputedTransfer& transfer) {
  const cpca::Encoding& encoding = transfer.encoding;
  const gltf::StoredBytes bytes = gltf::stored_bytes(transfer);
  return {{"cluster_indices", bytes.cluster_indices},
          {"weights", bytes.weights},
          {"means", bytes.means},
          {"bases", bytes.bases},
          {"tables", bytes.tables},
          {"total", bytes.total()},
          {"uncompressed",
           encoding.point_count * static_cast<std::size_t>(encoding.dimension) * sizeof(float)}};
}

void check_encoding(const gltf::PrecomputedTransfer& transfer, const mesh::Scene& scene,
                    Inspection& inspection) {
  const cpca::Encoding& encoding = transfer.encoding;
  if (encoding.point_count != scene.vertex_count()) {
    inspection.error(kTransferExtension, fmt::format("holds {} points, the scene has {} vertices",
                                                     encoding.point_count, scene.vertex_count()));
  }
  if (mesh::match_mesh_hash(transfer.mesh_hash, scene) == mesh::HashMatch::different) {
    inspection.warning(
        kTransferExtension,
        fmt::format("was baked for other geometry or colours: hash {}, the file's is {}",
                    transfer.mesh_hash, mesh::mesh_hash(scene)));
  }
  for (const auto& [name, values] : {std::pair{"means", &encoding.means},
                                     {"bases", &encoding.bases},
                                     {"weights", &encoding.weights}}) {
    const std::size_t bad = count_non_finite(*values);
    if (bad > 0) inspection.error(name, fmt::format("{} values are not finite", bad));
  }
}

void inspect_precomputed_transfer(const gltf::PrecomputedTransfer& transfer,
                                  const mesh::Scene& scene, Inspection& inspection) {
  const cpca::Encoding& encoding = transfer.encoding;
  const std::vector<double> sizes = cluster_sizes(encoding);
  const auto unused = std::count(sizes.begin(), sizes.end(), 0.0);
  const double orthonormality = orthonormality_error(transfer);
  const Json bytes = describe_bytes(transfer);
  inspection.json["precomputed_transfer"] = {
      {"band_count", transfer.band_count},
      {"row_count", transfer.row_count},
      {"channel_count", transfer.channel_count},
      {"dimension", encoding.dimension},
      {"brdf", transfer.brdf},
      {"mesh_hash", transfer.mesh_hash},
      {"point_count", encoding.point_count},
      {"cluster_count", encoding.cluster_count},
      {"component_count", encoding.component_count},
      {"adaptive", !encoding.component_counts.empty()},
      {"weights", cpca::name_of(transfer.weight_format)},
      {"supercluster_count", transfer.first_clusters.empty()
                                 ? static_cast<std::size_t>(encoding.cluster_count)
                                 : transfer.first_clusters.size()},
      {"unused_cluster_count", unused},
      {"cluster_size", describe_sizes(sizes)},
      {"bytes", bytes},
      {"compression_ratio", bytes["uncompressed"].get<double>() / bytes["total"].get<double>()},
      {"mean_values", range_of(encoding.means)},
      {"weight_values", range_of(encoding.weights)},
      {"orthonormality_error", orthonormality}};
  check_encoding(transfer, scene, inspection);
  if (!(orthonormality <= 1e-3)) {
    inspection.warning(
        "bases",
        fmt::format("vectors of a cluster are not orthonormal: off by {:.3g}", orthonormality));
  }
  if (unused > 0) inspection.warning("clusters", fmt::format("{} have no vertex", unused));
}

}  // namespace

void inspect_model(const std::filesystem::path& path, Inspection& inspection) {
  for (const std::string& violation : schema_violations(path)) {
    inspection.error(kTransferExtension, violation);
  }
  const gltf::Document document = gltf::Document::load(path);
  const mesh::Scene scene = document.scene();
  Json primitives = Json::array();
  for (const mesh::Primitive& primitive : scene.primitives) {
    primitives.push_back(describe(scene, primitive));
  }
  inspection.json["model"] = {
      {"vertex_count", scene.vertex_count()},     {"triangle_count", scene.triangle_count()},
      {"material_count", scene.materials.size()}, {"image_count", scene.images.size()},
      {"mesh_hash", mesh::mesh_hash(scene)},      {"primitives", primitives}};
  if (const auto transfer = document.precomputed_transfer()) {
    inspect_precomputed_transfer(*transfer, scene, inspection);
  }
}

}  // namespace prt::inspect
