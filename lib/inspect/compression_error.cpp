#include "inspect/compression_error.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "core/error.h"
#include "gltf/document.h"
#include "inspect/statistics.h"
#include "sh/basis.h"
#include "sh/radiance_metric.h"
#include "signal/transfer_signal.h"

namespace prt::inspect {

namespace {

// Sums of one primitive, or of all.
struct VertexSums {
  double squared_error = 0.0, energy = 0.0;
  std::size_t worst_vertex = 0;
  double worst = -1.0;
  std::vector<double> relative;

  void add(std::size_t vertex, double error, double signal_energy, double scale) {
    squared_error += error;
    energy += signal_energy;
    relative.push_back(std::sqrt(error) * scale);
    if (error > worst) {
      worst = error;
      worst_vertex = vertex;
    }
  }

  Json to_json() const {
    return {{"vertex_count", relative.size()},
            {"squared_error", squared_error},
            {"signal_energy", energy},
            {"relative_rmse", energy > 0.0 ? std::sqrt(squared_error / energy) : 0.0},
            {"vertex_error", percentiles_of(relative)},
            {"worst_vertex", worst_vertex}};
  }
};

void check_shape(const gltf::PrecomputedTransfer& transfer, const signal::TransferSignal& signal,
                 const std::filesystem::path& path) {
  const auto shape = [](const auto& t) {
    return fmt::format("{} bands, {} rows, {} channels", t.band_count, t.row_count,
                       t.channel_count);
  };
  if (shape(transfer) == shape(signal)) return;
  throw_bad_input("not the transfer that the model was compressed from",
                  {.file = path.string(), .found = shape(signal), .expected = shape(transfer)});
}

std::vector<double> energies(const signal::TransferSignal& signal) {
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  std::vector<double> energy(signal.vertex_count());
  for (std::size_t i = 0; i < signal.values.size(); ++i) {
    energy[i / dimension] += double{signal.values[i]} * signal.values[i];
  }
  return energy;
}

}  // namespace

CompressionError compression_error(const std::filesystem::path& model_path,
                                   const std::filesystem::path& transfer_path) {
  const gltf::Document document = gltf::Document::load(model_path);
  auto transfer = document.precomputed_transfer();
  if (!transfer) {
    throw_bad_input("holds no compressed transfer",
                    {.file = model_path.string(), .advice = "Run prt-compress on it."});
  }
  const mesh::Scene scene = document.scene();
  signal::TransferSignal signal = signal::read_transfer(transfer_path);
  signal::check_belongs_to(signal, scene, transfer_path);
  check_shape(*transfer, signal, transfer_path);
  const sh::RadianceMetric metric(signal.row_count, sh::row_size(signal.band_count));
  for (const std::span<float> rows : {std::span(signal.values), std::span(transfer->encoding.means),
                                      std::span(transfer->encoding.bases)})
    metric.apply(rows);

  const std::vector<double> errors = cpca::point_errors(transfer->encoding, signal.values);
  const std::vector<double> energy = energies(signal);
  double total_energy = 0.0;
  for (const double e : energy) total_energy += e;
  const double scale =
      total_energy > 0.0 ? std::sqrt(static_cast<double>(energy.size()) / total_energy) : 0.0;

  VertexSums total;
  Json primitives = Json::array();
  const std::vector<std::size_t> offsets = scene.vertex_offsets();
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    VertexSums sums;
    for (std::size_t v = offsets[p]; v < offsets[p + 1]; ++v) {
      sums.add(v - offsets[p], errors[v], energy[v], scale);
      total.add(v, errors[v], energy[v], scale);
    }
    Json row = {{"name", scene.primitives[p].name}};
    row.update(sums.to_json());
    primitives.push_back(row);
  }
  CompressionError result;
  result.json = total.to_json();
  result.json["primitives"] = primitives;
  result.relative = std::move(total.relative);
  return result;
}

}  // namespace prt::inspect
