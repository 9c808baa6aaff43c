#include "cpca/storage.h"

namespace prt::cpca {

Storage prepare_storage(std::span<const float> signal, std::span<const std::uint32_t> indices,
                        int row_count, const StorageOptions& options, Encoding& encoding,
                        Report& report) {
  Storage storage;
  if (!options.is_incoherent) {
    const StageTimer timer(report, "coherence");
    CoherenceOptions coherence = options.coherence;
    coherence.limits = options.limits;
    storage.coherence = make_coherent(signal, indices, row_count, coherence, encoding);
    storage.first_clusters = storage.coherence->first_clusters;
  }
  const StageTimer timer(report, "weights");
  storage.weight_format = choose_weights(signal, options.weights, encoding, options.limits);
  return storage;
}

}  // namespace prt::cpca
