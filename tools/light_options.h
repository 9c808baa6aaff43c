// The options of distant light, which prt-render and prt-view share.
#pragma once

#include <filesystem>
#include <optional>

#include "cli/options.h"
#include "sh/window.h"

namespace prt {

/// Adds to the current group of options.
inline void add_light(cli::Options& app, std::filesystem::path& light, int& band_count,
                      std::optional<sh::Window>& window) {
  app.add_option("--light", light,
                 "Light of prt-light (.json) or an environment map (.exr .hdr); none: a lamp");
  app.add_option("--bands", band_count,
                 "Bands that a map is projected to; 0: those of the transfer, else 5")
      ->check(cli::Range(0, 16));
  app.add_choice("--window", window, sh::kWindows,
                 "Damps the light's higher bands against ringing, not the background [none]");
}

}  // namespace prt
