// The search within a bound, over formats of weights as well.
#pragma once

#include "compress/encode.h"
#include "cpca/method.h"
#include "cpca/search.h"

namespace prt::compress {

cpca::Method method_of(const Job& job);

/// Of the squared error: what reclassification may add, for which a bound leaves room.
double reclassification_share(const Job& job);

/// Whether an encoding whose weights are stored, of the scaled signal, is within the bound.
bool is_within(const Job& job, cpca::WeightFormat format, const cpca::Encoding& stored,
               const Input& input);

/// `encode` (compress/encode.h) of a job with a bound.
Result search(const Job& job, const Input& input, const cpca::Options& options, Report& report);

}  // namespace prt::compress
