#include "inspect/hemisphere.h"

#include <algorithm>
#include <cmath>

#include "linalg/decompose.h"
#include "sh/basis.h"
#include "sh/hemisphere.h"

namespace prt::inspect {

namespace {

using sh::HemisphereProjection;
constexpr int kSignalBandCount = 5;

Json row(const char* name, HemisphereProjection kind, int function_count) {
  const std::vector<int> functions = sh::hemisphere_functions(function_count);
  const std::vector<double> projection = sh::hemisphere_projection(kind, functions);
  int used = 0;
  for (std::size_t i = 0; i < functions.size(); ++i) {
    used += projection[i * functions.size() + i] != 0;
  }
  const auto error = sh::hemisphere_error(kind, functions, kSignalBandCount);
  const double worst = std::max(error.worst, 0.0), mean = std::max(error.mean, 0.0);
  return {{"projection", name},
          {"band_count", sh::band_count_of(functions)},
          {"function_count", used},
          {"worst_squared_error", worst},
          {"mean_squared_error", mean},
          {"worst_rms_error", std::sqrt(worst)},
          {"mean_rms_error", std::sqrt(mean)}};
}

Json singular_values(const std::vector<int>& functions) {
  const std::size_t size = functions.size();
  const std::vector<double> gram = sh::hemisphere_gram(functions, functions);
  const auto values = linalg::svd({gram.data(), size, size}).values;
  return {{"largest", values[0]},
          {"second_smallest", values[size - 2]},
          {"smallest", values[size - 1]}};
}

}  // namespace

Json hemisphere_table() {
  const std::vector<int> functions =
      sh::hemisphere_functions(sh::coefficient_count(kSignalBandCount));
  Json table;
  table["signal_band_count"] = kSignalBandCount;
  table["singular_values"] = singular_values(functions);
  table["dropped"] = {{"function", "l=1 m=0"}, {"squared_error", sh::dropping_error(functions, 2)}};
  table["projections"] = {row("least squares", HemisphereProjection::least_squares, 25),
                          row("least squares", HemisphereProjection::least_squares, 24),
                          row("zero hemisphere", HemisphereProjection::zero_hemisphere, 25),
                          row("odd reflection", HemisphereProjection::odd_reflection, 64),
                          row("even reflection", HemisphereProjection::even_reflection, 49),
                          row("even reflection", HemisphereProjection::even_reflection, 25)};
  return table;
}

}  // namespace prt::inspect
