// Options of several numbers: --name X,Y,Z and --size WIDTHxHEIGHT.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/vec.h"

namespace prt::cli {

/// Sets `value`, a Vec3 or an optional one.
template <class Vector>
void add_vector(CLI::App& app, const char* name, Vector& value, const std::string& description) {
  app.add_option_function<std::vector<float>>(
         name,
         [&value, name](const std::vector<float>& v) {
           if (v.size() != 3) throw CLI::ValidationError(name, "expected X,Y,Z");
           value = Vec3(v[0], v[1], v[2]);
         },
         description)
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
}

/// --size, in pixels, each from 1 to 16384.
void add_size(CLI::App& app, int& width, int& height, const std::string& description);

}  // namespace prt::cli
