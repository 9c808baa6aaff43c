#include "cpca/equal_rows.h"

#include <string_view>
#include <unordered_map>

namespace prt::cpca {

std::optional<EqualRows> find_equal_rows(std::span<const float> signal, std::size_t dimension,
                                         std::size_t most_count) {
  const std::size_t point_count = signal.size() / dimension, row_bytes = dimension * sizeof(float);
  const std::string_view bytes(reinterpret_cast<const char*>(signal.data()), signal.size_bytes());
  EqualRows rows;
  std::unordered_map<std::string_view, std::uint32_t> numbers;
  for (std::size_t p = 0; p < point_count; ++p) {
    const auto [row, is_new] =
        numbers.try_emplace(bytes.substr(p * row_bytes, row_bytes), rows.first.size());
    if (is_new) rows.first.push_back(static_cast<std::uint32_t>(p));
    if (rows.first.size() > most_count) return std::nullopt;
    rows.labels.push_back(row->second);
  }
  return rows;
}

}  // namespace prt::cpca
