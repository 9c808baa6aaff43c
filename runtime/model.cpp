#include "runtime/model.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>

#include "core/error.h"
#include "core/exit_rows.h"
#include "core/log.h"
#include "gltf/document.h"
#include "mesh/frame.h"
#include "runtime/triangle_order.h"
#include "sh/basis.h"
#include "sh/radiance_metric.h"

namespace prt::runtime {

namespace {

void check_transfer(std::size_t vertex_count, std::size_t found_vertex_count, int row_count) {
  if (found_vertex_count != vertex_count)
    throw_bad_input(
        "the transfer has another number of vertices than the model",
        {.found = std::to_string(found_vertex_count), .expected = std::to_string(vertex_count)});
  if (!is_exit_row_count(row_count))
    throw_bad_input("the transfer's exit rows are no set of hemispherical functions",
                    {.found = std::to_string(row_count) + " rows", .expected = kExitRowCounts});
}

void check_alike(const gltf::PrecomputedTransfer& transfer, const signal::TransferSignal& signal) {
  const auto shape = [](const auto& t) {
    return fmt::format("{} bands, {} rows, {} channels", t.band_count, t.row_count,
                       t.channel_count);
  };
  if (shape(signal) != shape(transfer))
    throw_bad_input("compressed and uncompressed transfer differ",
                    {.found = shape(signal), .expected = shape(transfer)});
}

void add_frames(const mesh::Scene& scene, Model& model) {
  for (const mesh::Primitive& primitive : scene.primitives)
    for (std::size_t v = 0; v < primitive.mesh.vertex_count(); ++v) {
      const mesh::Frame frame = mesh::frame_at_vertex(primitive.mesh, v);
      const float side = frame.z.cross(frame.x).dot(frame.y) < 0.0f ? -1.0f : 1.0f;
      model.normals.push_back(frame.z);
      model.tangents.emplace_back(frame.x.x, frame.x.y, frame.x.z, side);
    }
}

/// As many vertices can be drawn, whatever they are: a hash is for people.
void warn_of_another_mesh(const gltf::PrecomputedTransfer& transfer, const mesh::Scene& scene,
                          const std::filesystem::path& glb) {
  if (mesh::match_mesh_hash(transfer.mesh_hash, scene) != mesh::HashMatch::different) return;
  log::warning(
      "{}: the precomputed transfer was baked for other geometry or colours (meshHash {}, the "
      "file's is {}), and may look wrong. Run prt-transfer and prt-compress again",
      glb.string(), transfer.mesh_hash, mesh::mesh_hash(scene));
}

/// Transfer has one albedo a vertex.
void warn_of_textures(const mesh::Scene& scene, const std::filesystem::path& glb) {
  for (const mesh::Primitive& primitive : scene.primitives) {
    if (primitive.material < 0) continue;
    const auto material = static_cast<std::size_t>(primitive.material);
    if (scene.materials[material].base_color_image < 0) continue;
    log::warning(
        "{}: the base colour texture is drawn as it is at the vertices; finer detail "
        "needs a finer mesh",
        glb.string());
    return;
  }
}

}  // namespace

int Model::band_count() const {
  return transfer ? transfer->band_count : signal ? signal->band_count : 0;
}

int Model::row_count() const {
  return transfer ? transfer->row_count : signal ? signal->row_count : 1;
}

Model make_model(const mesh::Scene& scene, std::optional<gltf::PrecomputedTransfer> transfer,
                 std::optional<signal::TransferSignal> signal) {
  Model model;
  for (const mesh::Primitive& primitive : scene.primitives) {
    const mesh::TriangleMesh& mesh = primitive.mesh;
    model.positions.insert(model.positions.end(), mesh.positions.begin(), mesh.positions.end());
  }
  const std::size_t vertex_count = model.positions.size();
  model.indices = ordered_for_vertex_reuse(scene.indices(), vertex_count);
  model.bounds = camera::bounding_sphere(scene);
  if (transfer) check_transfer(vertex_count, transfer->encoding.point_count, transfer->row_count);
  if (signal) check_transfer(vertex_count, signal->vertex_count(), signal->row_count);
  if (transfer && signal) check_alike(*transfer, *signal);
  model.transfer = std::move(transfer);
  model.signal = std::move(signal);
  if (model.row_count() > 1) add_frames(scene, model);
  return model;
}

Model load_model(const std::filesystem::path& glb, const std::filesystem::path& transfer) {
  const gltf::Document document = gltf::Document::load(glb);
  const mesh::Scene scene = document.scene();
  std::optional<gltf::PrecomputedTransfer> compressed = document.precomputed_transfer();
  if (compressed) warn_of_another_mesh(*compressed, scene, glb);
  warn_of_textures(scene, glb);
  std::optional<signal::TransferSignal> signal;
  if (!transfer.empty()) {
    signal = signal::read_transfer(transfer);
    signal::check_belongs_to(*signal, scene, transfer);
  }
  if (!compressed && !signal)
    throw_bad_input("there is no precomputed transfer to draw",
                    {.file = glb.string(),
                     .expected = "the extension PRTKIT_precomputed_transfer",
                     .advice = "Bake it with prt-transfer and prt-compress, or give --transfer."});
  return make_model(scene, std::move(compressed), std::move(signal));
}

std::vector<float> relative_errors(const Model& model) {
  if (!model.transfer || !model.signal) return {};
  std::vector<float> values = model.signal->values;
  cpca::Encoding encoding = model.transfer->encoding;
  const sh::RadianceMetric metric(model.row_count(), sh::row_size(model.band_count()));
  for (const std::span<float> rows :
       {std::span(values), std::span(encoding.means), std::span(encoding.bases)})
    metric.apply(rows);
  const std::vector<double> errors = cpca::point_errors(encoding, values);
  double energy = 0.0;
  for (const float value : values) energy += double{value} * value;
  const double mean_energy = energy / static_cast<double>(errors.size());
  std::vector<float> relative(errors.size());
  for (std::size_t i = 0; i < errors.size(); ++i)
    relative[i] = mean_energy > 0.0 ? static_cast<float>(std::sqrt(errors[i] / mean_energy)) : 0.0f;
  return relative;
}

float relative_error(const Model& model) {
  double square = 0.0, count = 1e-30;
  for (const float error : relative_errors(model)) square += double{error} * error, count += 1.0;
  return static_cast<float>(std::sqrt(square / count));
}

}  // namespace prt::runtime
