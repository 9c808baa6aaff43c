#pragma once

#include "core/report.h"
#include "sh/window.h"

namespace prt::sh {

/// Adds "window": name, strength, minimum_over_mean, negative_fraction.
void report_window(const WindowedLight& windowed, Report& report);

}  // namespace prt::sh
