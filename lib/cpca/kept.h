// What encoders and searches keep in a checkpoint (core/checkpoint.h).
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "cpca/encoder.h"

namespace prt::cpca {

/// Stages of a search: columns of the survey, finished encodings, and what is kept of the first,
/// the second, … encoding while it is made.
enum KeptStage : std::uint32_t { kSurveyStage, kTrialStage, kEncoderStage };

void archive(Archive& archive, std::vector<Level>& levels);
/// All but its stages, and weights of points, which follow from the rest (cpca/fit.h).
void archive(Archive& archive, Encoded& encoded);

int iteration_count(const std::vector<Level>& levels);

}  // namespace prt::cpca
