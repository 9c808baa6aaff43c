// How the exit values of a transfer lie in vec4 on the GPU.
//
// Diffuse transfer has one exit row: its three colours are one vector, (R, G, B, 0). Glossy
// transfer has `row_count` coefficients of exit radiance a colour, packed by fours into slots:
// first those of (l,m) and (l,-m) side by side, m > 0, so that a shader turns them about the normal
// as it turns pairs of coordinates, then those of m = 0. All colours are drawn in one pass, one
// colour's vectors after the other, or each in its own.
#pragma once

#include <cstddef>
#include <vector>

#include "core/vec.h"

namespace prt::runtime {

struct ExitLayout {
  int row_count = 1;
  int pass_count = 1;            ///< 1, or 3: a colour each; 1 when diffuse
  int band_count = 1;            ///< of exit radiance
  std::vector<int> functions{};  ///< of the rows: sh::hemisphere_functions; empty when diffuse
  std::vector<int>
      row_of_slot{};  ///< row_count of them; the slots that fill the last vec4 have none
  std::vector<int> order_of_pair{};  ///< |m| of slots 2i and 2i + 1

  bool is_glossy() const { return row_count > 1; }
  /// vec4 for one colour (when diffuse, for all).
  std::size_t color_vector_count() const { return (row_of_slot.size() + 3) / 4; }
  /// Of which there are so many.
  std::size_t color_count() const { return is_glossy() ? 3 : 1; }
  /// Colours that a pass draws, and the vec4 it has for a vertex.
  std::size_t pass_color_count() const { return is_glossy() && pass_count == 1 ? 3 : 1; }
  std::size_t pass_vector_count() const { return pass_color_count() * color_vector_count(); }
  std::size_t slot_count() const { return 4 * color_vector_count(); }
};

/// `row_count`: 1, or n² or n² - 1 as sh::hemisphere_functions has them. Throws Error (usage).
ExitLayout exit_layout(int row_count, int pass_count);

}  // namespace prt::runtime
