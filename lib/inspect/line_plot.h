// Curves over two axes, as plot and as table.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace prt::inspect {

struct Series {
  std::string name;
  std::vector<double> x, y;  ///< as many of either, x rising
};

struct LinePlot {
  std::string title, x_label, y_label;
  bool log_x = false;  ///< y is always logarithmic: errors
  std::vector<Series> series;
};

/// "series,x,y" lines, the second and third named by the labels.
std::string to_csv(const LinePlot& plot);

/// Curves with marks and a legend. Values that a logarithmic axis does not have are left out.
image::Image draw(const LinePlot& plot);

}  // namespace prt::inspect
