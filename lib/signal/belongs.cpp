#include <fmt/format.h>

#include "core/error.h"
#include "core/log.h"
#include "signal/transfer_signal.h"

namespace prt::signal {

void check_belongs_to(const TransferSignal& signal, const mesh::Scene& scene,
                      const std::filesystem::path& signal_path) {
  const char* advice =
      "Geometry or colours differ from those it was baked for: run prt-transfer again on this "
      "model, or name the model that it was run on.";
  const auto reject = [&](std::string element, std::string found, std::string expected) {
    throw_bad_input("the transfer belongs to another mesh", {.file = signal_path.string(),
                                                             .element = std::move(element),
                                                             .found = std::move(found),
                                                             .expected = std::move(expected),
                                                             .advice = advice});
  };
  if (signal.blocks.size() != scene.primitives.size()) {
    reject("", fmt::format("{} primitives", signal.blocks.size()),
           fmt::format("{}", scene.primitives.size()));
  }
  for (std::size_t i = 0; i < signal.blocks.size(); ++i) {
    const std::size_t vertex_count = scene.primitives[i].mesh.vertex_count();
    if (signal.blocks[i].vertex_count == vertex_count) continue;
    reject(fmt::format("primitive {} ({})", i, scene.primitives[i].name),
           fmt::format("{} vertices", signal.blocks[i].vertex_count),
           fmt::format("{}", vertex_count));
  }
  const mesh::HashMatch match = mesh::match_mesh_hash(signal.mesh_hash, scene);
  if (match == mesh::HashMatch::different) {
    reject("mesh hash", signal.mesh_hash, mesh::mesh_hash(scene));
  }
  if (match == mesh::HashMatch::unknown && !signal.mesh_hash.empty()) {
    log::warning(
        "{}: its mesh hash is by another version of prtkit: the vertex counts fit, but not whether "
        "geometry or colours were changed after baking can be told",
        signal_path.string());
  }
}

}  // namespace prt::signal
