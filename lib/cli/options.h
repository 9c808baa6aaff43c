// Describing a tool's options: the part of CLI11 that the tools use, compiled once. CLI11 itself is
// all headers and takes longer to compile than everything else in a tool.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace prt::cli {

/// What values an option takes.
using Validator = std::shared_ptr<const CLI::Validator>;
Validator Range(int low, int high);  ///< both included
Validator Range(double low, double high);
Validator at_least_zero();
Validator above_zero();
Validator IsMember(const std::vector<std::string>& names);
/// What a function takes that throws Error for the rest.
Validator accepted_by(const std::function<void(const std::string&)>& function);
template <class T>
Validator IsMember(const std::map<std::string, T>& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  return IsMember(names);
}

/// An option that has been added; each call returns the option again.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option* required();
  Option* check(const Validator& validator);
  Option* needs(const Option* other);
  Option* excludes(const Option* other);
  Option* group(const std::string& headline);     ///< where --help lists it
  Option* type_name(const std::string& name);     ///< how --help calls its values
  Option* default_str(const std::string& shown);  ///< what --help calls its default
  Option* numbers(int count);                     ///< so many, with commas between
  Option* repeated_numbers(int count);            ///< so many each time that it is given
  Option* values(int count);                      ///< so many, with spaces between

 private:
  CLI::Option* option_;
};

/// A tool's options and arguments. Names are as in CLI11: "-o,--output", "input". Wrong usage is
/// found when the command line is parsed, by Tool::run.
class Options {
 public:
  explicit Options(CLI::App& app) : app_(app) {}

  /// The default that --help shows is the value at the time of the call. T: int, std::size_t,
  /// float, double, std::string, std::filesystem::path, std::optional or std::vector of one.
  template <class T>
  Option* add_option(const std::string& name, T& value, const std::string& description);
  /// Three numbers, X,Y,Z, into a Vec3 or an optional one.
  template <class Vector>
  Option* add_vector(const std::string& name, Vector& value, const std::string& description) {
    return add_vector(
        name, [&value](const Vec3& v) { value = v; }, description);
  }
  /// `count` numbers each time that it is given, then `set` gets them.
  Option* add_repeated_numbers(const std::string& name, int count,
                               const std::function<void(std::span<const float>)>& set,
                               const std::string& description);
  /// WIDTHxHEIGHT in pixels, each from 1 to 16384.
  Option* add_size(const std::string& name, int& width, int& height,
                   const std::string& description);
  /// `set` gets the text as it was given, and can throw Error (usage).
  Option* add_text(const std::string& name, const std::function<void(const std::string&)>& set,
                   const std::string& description);
  /// One of the names, for its value.
  template <class Value, class T>
  Option* add_choice(const std::string& name, Value& value, const std::map<std::string, T>& values,
                     const std::string& description) {
    return add_text(
               name, [&value, values](const auto& text) { value = values.at(text); }, description)
        ->check(IsMember(values))
        ->type_name("NAME");
  }
  Option* add_flag(const std::string& name, bool& value, const std::string& description);
  /// Headline of --help for what is added from here on.
  void start_group(const std::string& headline);
  Option* get(const std::string& name);

 private:
  Option* add_vector(const std::string& name, const std::function<void(const Vec3&)>& set,
                     const std::string& description);
  Option* keep(CLI::Option* option);

  CLI::App& app_;
  std::vector<std::unique_ptr<Option>> options_;
};

}  // namespace prt::cli
