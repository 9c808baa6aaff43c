// The options of lights near the model, which prt-render and prt-view share.
#pragma once

#include <span>
#include <vector>

#include "cli/options.h"
#include "runtime/light_field.h"

namespace prt {

/// Adds to the current group of options. Both kinds of light can be given any number of times.
inline void add_near_lights(cli::Options& app, std::vector<runtime::NearLight>& lights,
                            int& grid_size) {
  const auto add = [&](const char* name, int number_count, const char* type, const char* help) {
    app.add_repeated_numbers(
           name, number_count,
           [&lights](std::span<const float> numbers) {
             lights.push_back(runtime::near_light(numbers));
           },
           help)
        ->type_name(type);
  };
  add("--point-light", 6, "X,Y,Z,R,G,B",
      "A point near the model: where, irradiance at distance 1 on a facing surface");
  add("--sphere-light", 7, "X,Y,Z,RADIUS,R,G,B",
      "A sphere near the model: where, radius, radiance");
  app.add_option(
         "--light-grid", grid_size,
         "Near lights are sampled at N x N x N points over the model and blended; 1: at its "
         "middle")
      ->check(cli::Range(1, runtime::kMaxGridSize));
}

}  // namespace prt
