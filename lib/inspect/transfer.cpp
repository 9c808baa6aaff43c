#include <fmt/format.h>

#include "inspect/inspection.h"
#include "inspect/statistics.h"
#include "signal/transfer_signal.h"

namespace prt::inspect {

namespace {

// Sum of squares over vertices, channels and exit rows, band by band.
std::vector<double> energy_per_band(const signal::TransferSignal& signal) {
  std::vector<double> energy(static_cast<std::size_t>(signal.band_count));
  const int coefficient_count = signal.band_count * signal.band_count;
  for (std::size_t i = 0; i < signal.values.size(); ++i) {
    const auto k = static_cast<int>(i % static_cast<std::size_t>(coefficient_count));
    int band = 0;
    while ((band + 1) * (band + 1) <= k) ++band;
    energy[static_cast<std::size_t>(band)] += double{signal.values[i]} * signal.values[i];
  }
  return energy;
}

}  // namespace

void inspect_transfer(const std::filesystem::path& path, Inspection& inspection) {
  const signal::TransferSignal signal = signal::read_transfer(path);
  Json blocks = Json::array();
  for (const auto& block : signal.blocks) {
    blocks.push_back({{"name", block.name}, {"vertex_count", block.vertex_count}});
  }
  Json& json = inspection.json["transfer"];
  json = {{"band_count", signal.band_count},
          {"row_count", signal.row_count},
          {"channel_count", signal.channel_count},
          {"dimension", signal.dimension()},
          {"brdf", signal.brdf},
          {"vertex_count", signal.vertex_count()},
          {"ray_count", signal.ray_count},
          {"bounce_count", signal.bounce_count},
          {"seed", signal.seed},
          {"tool_version", signal.tool_version},
          {"mesh_hash", signal.mesh_hash}};
  json["values"] = range_of(signal.values);
  const std::vector<double> energy = energy_per_band(signal);
  double total = 0.0;
  for (const double e : energy) total += e;
  json["energy"] = total;
  json["energy_per_band"] = energy;
  json["blocks"] = blocks;
  const std::size_t bad = count_non_finite(signal.values);
  if (bad > 0) inspection.error("values", fmt::format("{} are not finite", bad));
  if (total == 0.0) inspection.warning("values", "all are zero: nothing is lit");
}

}  // namespace prt::inspect
