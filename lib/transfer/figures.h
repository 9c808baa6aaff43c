// What a bake was like, for reports and people.
#pragma once

#include "core/report.h"
#include "signal/transfer_signal.h"
#include "transfer/diffuse.h"

namespace prt::transfer {

/// The keys and stages of docs/tools/prt-transfer.md; a warning where vertices are buried, and a
/// line on how much was traced.
void report_figures(Report& report, const DiffuseStats& stats,
                    const signal::TransferSignal& signal);

}  // namespace prt::transfer
