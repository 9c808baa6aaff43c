// Messages for people, on standard error, through spdlog: quiet hides all but errors, -v shows
// debug.
#pragma once

#include <fmt/format.h>

#include <string_view>

namespace prt::log {

enum class Level { debug, info, warning, error };

void set_level(Level lowest);
void write(Level level, std::string_view message);

template <class... Args>
void debug(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::debug, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void info(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::info, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void warning(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::warning, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace prt::log
