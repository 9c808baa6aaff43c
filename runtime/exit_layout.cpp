#include "runtime/exit_layout.h"

#include <algorithm>

#include "sh/basis.h"
#include "sh/hemisphere.h"

namespace prt::runtime {

ExitLayout exit_layout(int row_count, int pass_count) {
  ExitLayout layout{.row_count = row_count, .pass_count = row_count > 1 ? pass_count : 1};
  if (row_count == 1) {
    layout.row_of_slot = {0};
    return layout;
  }
  layout.functions = sh::hemisphere_functions(row_count);
  layout.band_count = sh::band_count_of(layout.functions);
  const auto row_of = [&](int l, int m) {
    const auto place =
        std::find(layout.functions.begin(), layout.functions.end(), sh::coefficient_index(l, m));
    return static_cast<int>(place - layout.functions.begin());
  };
  for (int m = 1; m < layout.band_count; ++m)
    for (int l = m; l < layout.band_count; ++l) {
      layout.row_of_slot.insert(layout.row_of_slot.end(), {row_of(l, m), row_of(l, -m)});
      layout.order_of_pair.push_back(m);
    }
  for (int l = 0; l < layout.band_count; ++l)
    if (const int row = row_of(l, 0); row < row_count) layout.row_of_slot.push_back(row);
  layout.order_of_pair.resize(layout.slot_count() / 2, 0);
  return layout;
}

}  // namespace prt::runtime
