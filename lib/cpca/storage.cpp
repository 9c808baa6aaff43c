#include "cpca/storage.h"

namespace prt::cpca {

Storage prepare_storage(std::span<const float> signal, std::span<const std::uint32_t> indices,
                        int row_count, const StorageOptions& options, Encoding& encoding,
                        Report& report) {
  Storage storage;
  if (!options.is_incoherent) {
    const StageTimer timer(report, "coherence");
    const Coherence coherence =
        make_coherent(signal, indices, row_count, options.coherence, encoding);
    report.json().update(to_json(coherence, options.coherence));
    storage.first_clusters = coherence.first_clusters;
  } else {
    report.json().update(overdraw_to_json(indices, encoding));
  }
  const StageTimer timer(report, "weights");
  storage.weight_format = choose_weights(signal, options.weights, encoding);
  report.json()["weights"] = name_of(storage.weight_format);
  return storage;
}

}  // namespace prt::cpca
