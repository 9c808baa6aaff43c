// Options that take one of several names: --name NAME.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace prt::cli {

/// Sets `value`, an Enum or an optional one. `names` must outlive the parsing.
template <class Enum, class Value>
void add_choice(CLI::App& app, const char* name, Value& value,
                const std::map<std::string, Enum>& names, const std::string& description) {
  app.add_option_function<std::string>(
         name, [&](const std::string& text) { value = names.at(text); }, description)
      ->check(CLI::IsMember(names))
      ->type_name("NAME");
}

}  // namespace prt::cli
