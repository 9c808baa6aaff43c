// From a signal to its encoding as it is stored: an encoder, or the search within the bound of a
// job, then coherence and weights, which must keep to the bound as well.
#pragma once

#include <optional>

#include "compress/input.h"
#include "compress/job.h"
#include "core/report.h"
#include "cpca/encoder.h"
#include "cpca/weight_format.h"

namespace prt::compress {

struct Result {
  cpca::Encoded encoded;                      ///< weights are floats
  std::optional<cpca::WeightFormat> weights;  ///< for the file; unset: choose_weights decides
  double reserve = 0.0;                       ///< share of max_error² that their rounding may take
};

/// Encodes a scaled signal with the counts of the job, or searches; clusters without points are
/// left out. Of a model the search measures
/// errors with weights as they will be stored: unless the job says how, as integers of 8 bits, and
/// again as finer ones while what rounding adds is more than they might cost; of these the best is
/// taken. Adds to the report what docs/tools/prt-compress.md says of searches. Throws Error
/// (failed) when nothing is within the bound.
Result encode(const Job& job, const Input& input, Report& report);

/// Makes the encoding of a model coherent and its weights what is stored, within the bound of the
/// job: where coherence would break it, without. Stages of the report as cpca::prepare_storage.
cpca::Storage store(const Job& job, const Input& input, Result& result, Report& report);

}  // namespace prt::compress
