// Histograms over decades, as plot and as table.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace prt::inspect {

/// Bins of equal width in log10, whole decades.
struct Histogram {
  static constexpr int kBinsPerDecade = 10;
  int first_decade = 0, last_decade = 0;  ///< 10^first to 10^last
  std::vector<std::size_t> counts;        ///< kBinsPerDecade × decades
  std::size_t zero_count = 0;             ///< values of 0, in no bin
  double median = 0.0, percentile_99 = 0.0;

  double lower_edge(std::size_t bin) const;
};

/// Of non-negative values. The smallest decade is at most six below the largest; what is smaller
/// counts in the first bin.
Histogram make_histogram(std::vector<double> values);

/// "lower,upper,count" lines; zeros as 0,0,count.
std::string to_csv(const Histogram& histogram);

/// Bars over a logarithmic axis, median and 99th percentile marked.
image::Image plot(const Histogram& histogram, const std::string& title,
                  const std::string& axis_label);

}  // namespace prt::inspect
