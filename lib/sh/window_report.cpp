#include "sh/window_report.h"

namespace prt::sh {

void report_window(const WindowedLight& windowed, Report& report) {
  report.json()["window"] = {{"name", name_of(windowed.window)},
                             {"strength", windowed.strength},
                             {"minimum_over_mean", windowed.ringing.minimum_over_mean},
                             {"negative_fraction", windowed.ringing.negative_fraction}};
}

}  // namespace prt::sh
