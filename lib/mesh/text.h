// Text mesh formats word by word. Nothing here allocates or trusts its input.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace prt::mesh {

/// Splits a text into lines (LF, CR LF or CR), counted from 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}
  /// The next line without its end; nullopt after the last.
  std::optional<std::string_view> next();
  std::size_t line_number() const { return line_number_; }

 private:
  std::string_view rest_;
  std::size_t line_number_ = 0;
};

/// Takes the next word (separated by spaces and tabs) off the front; empty at the end.
std::string_view take_word(std::string_view& line);
/// `text` without spaces and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// The whole word as a number; "nan" and "inf" are numbers here, and what they do to a mesh is for
/// repair. Out of range becomes infinite, too small 0. nullopt for anything else.
std::optional<float> to_float(std::string_view word);
/// A double as float; beyond its range, where conversion is undefined, the infinity it means.
float narrowed(double value);
std::optional<long long> to_integer(std::string_view word);

/// At most 40 characters of hostile text, for messages.
std::string excerpt(std::string_view text);

}  // namespace prt::mesh
