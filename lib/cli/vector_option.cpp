#include "cli/vector_option.h"

#include <algorithm>
#include <cstdio>

namespace prt::cli {

void add_size(CLI::App& app, int& width, int& height, const std::string& description) {
  app.add_option_function<std::string>(
         "--size",
         [&](const std::string& size) {
           char end = 0;
           if (std::sscanf(size.c_str(), "%5dx%5d%c", &width, &height, &end) != 2 ||
               std::min(width, height) < 1 || std::max(width, height) > 16384) {
             throw CLI::ValidationError(
                 "--size", "expected WIDTHxHEIGHT, each from 1 to 16384, found " + size);
           }
         },
         description)
      ->type_name("WxH");
}

}  // namespace prt::cli
