#include "cli/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "core/error.h"

namespace prt::cli {

namespace {

/// CLI11's own say C++'s names of limits and types. `type` is what --help shows.
Validator check_of(const std::string& type, const std::function<bool(const std::string&)>& holds,
                   const std::string& expected) {
  return std::make_shared<CLI::Validator>(
      [holds, expected](const std::string& value) {
        return holds(value) ? "" : fmt::format("expected {}, found {}", expected, value);
      },
      type);
}

template <class Number>
Validator number_check(const std::string& type, const std::function<bool(Number)>& holds,
                       const std::string& expected) {
  const auto is_good = [holds](const std::string& value) {
    Number number{};
    return CLI::detail::lexical_cast(value, number) && holds(number);
  };
  return check_of(type, is_good, expected);
}

template <class Number>
Validator range_of(const char* type, const char* number, Number low, Number high) {
  return number_check<Number>(
      fmt::format("{} in [{} - {}]", type, low, high),
      [low, high](Number x) { return low <= x && x <= high; },
      fmt::format("{} from {} to {}", number, low, high));
}

void check_count(const std::string& name, std::span<const float> values, std::size_t count) {
  if (!values.empty() && values.size() % count == 0) return;
  throw Error(ErrorKind::usage, name + ": wrong count",
              {.found = fmt::format("{}", fmt::join(values, ",")),
               .expected = fmt::format("{} values", count)});
}

}  // namespace

Validator Range(int low, int high) { return range_of("INT", "a whole number", low, high); }
Validator Range(double low, double high) { return range_of("FLOAT", "a number", low, high); }
Validator at_least_zero() {
  return number_check<double>(
      "NONNEGATIVE", [](double x) { return x >= 0.0; }, "a number from 0 up");
}
Validator above_zero() {
  return number_check<double>(
      "POSITIVE", [](double x) { return x > 0.0; }, "a number above 0");
}
Validator accepted_by(const std::function<void(const std::string&)>& function) {
  return std::make_shared<CLI::Validator>(
      [function](const std::string& value) {
        try {
          function(value);
        } catch (const Error& error) {
          return std::string(error.what());
        }
        return std::string();
      },
      "");
}
Validator IsMember(const std::vector<std::string>& names) {
  return check_of(
      fmt::format("{{{}}}", fmt::join(names, ",")),
      [names](const std::string& value) { return std::ranges::count(names, value) > 0; },
      fmt::format("{}{}", names.size() > 1 ? "one of " : "", fmt::join(names, ", ")));
}

Option* Option::required() {
  option_->required();
  return this;
}

Option* Option::check(const Validator& validator) {
  option_->check(*validator);
  return this;
}

Option* Option::needs(const Option* other) {
  option_->needs(other->option_);
  return this;
}

Option* Option::excludes(const Option* other) {
  option_->excludes(other->option_);
  return this;
}

Option* Option::group(const std::string& headline) {
  option_->group(headline);
  return this;
}

Option* Option::type_name(const std::string& name) {
  option_->type_name(name);
  return this;
}

Option* Option::default_str(const std::string& shown) {
  option_->default_str(shown);
  return this;
}

Option* Option::numbers(int count) {
  option_->delimiter(',');
  return values(count);
}

Option* Option::repeated_numbers(int count) {
  option_->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return numbers(count);
}

Option* Option::values(int count) {
  option_->expected(count);
  return this;
}

Option* Options::keep(CLI::Option* option) {
  return options_.emplace_back(std::make_unique<Option>(option)).get();
}

template <class T>
Option* Options::add_option(const std::string& name, T& value, const std::string& description) {
  return keep(app_.add_option(name, value, description));
}

#define PRTKIT_OPTION_OF(...) \
  template Option* Options::add_option(const std::string&, __VA_ARGS__&, const std::string&);
PRTKIT_OPTION_OF(int)
PRTKIT_OPTION_OF(unsigned int)
PRTKIT_OPTION_OF(std::size_t)
PRTKIT_OPTION_OF(float)
PRTKIT_OPTION_OF(double)
PRTKIT_OPTION_OF(std::string)
PRTKIT_OPTION_OF(std::filesystem::path)
PRTKIT_OPTION_OF(std::optional<int>)
PRTKIT_OPTION_OF(std::optional<float>)
PRTKIT_OPTION_OF(std::optional<double>)
PRTKIT_OPTION_OF(std::optional<std::size_t>)
PRTKIT_OPTION_OF(std::optional<std::string>)
PRTKIT_OPTION_OF(std::vector<float>)
PRTKIT_OPTION_OF(std::vector<std::filesystem::path>)
#undef PRTKIT_OPTION_OF

Option* Options::add_vector(const std::string& name, const std::function<void(const Vec3&)>& set,
                            const std::string& description) {
  const auto set_values = [name, set](const std::vector<float>& v) {
    for (const float x : v) {
      if (!std::isfinite(x)) throw Error(ErrorKind::usage, name + ": not a finite number");
    }
    check_count(name, v, 3);
    set(Vec3(v[0], v[1], v[2]));
  };
  return keep(app_.add_option_function<std::vector<float>>(name, set_values, description))
      ->numbers(3)
      ->type_name("X,Y,Z");
}

Option* Options::add_repeated_numbers(const std::string& name, int count,
                                      const std::function<void(std::span<const float>)>& set,
                                      const std::string& description) {
  const auto set_values = [name, set, count](const std::vector<float>& values) {
    const std::span<const float> all = values;
    const auto step = static_cast<std::size_t>(count);
    check_count(name, all, step);
    try {
      for (std::size_t first = 0; first < all.size(); first += step) set(all.subspan(first, step));
    } catch (const Error& error) {
      throw Error(ErrorKind::usage, name + ": " + error.what());
    }
  };
  return keep(app_.add_option_function<std::vector<float>>(name, set_values, description))
      ->repeated_numbers(count);
}

Option* Options::add_size(const std::string& name, int& width, int& height,
                          const std::string& description) {
  const auto set = [name, &width, &height](const std::string& size) {
    char end = 0;
    if (std::sscanf(size.c_str(), "%5dx%5d%c", &width, &height, &end) != 2 ||
        std::min(width, height) < 1 || std::max(width, height) > 16384) {
      throw Error(ErrorKind::usage, name + ": not a size",
                  {.found = size, .expected = "WIDTHxHEIGHT, each from 1 to 16384"});
    }
  };
  return add_text(name, set, description)->type_name("WxH");
}

Option* Options::add_text(const std::string& name,
                          const std::function<void(const std::string&)>& set,
                          const std::string& description) {
  return keep(app_.add_option_function<std::string>(name, set, description));
}

Option* Options::add_flag(const std::string& name, bool& value, const std::string& description) {
  return keep(app_.add_flag(name, value, description));
}

void Options::start_group(const std::string& headline) { app_.option_defaults()->group(headline); }

Option* Options::get(const std::string& name) { return keep(app_.get_option(name)); }

}  // namespace prt::cli
