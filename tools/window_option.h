// The option of damping light against ringing, which prt-render and prt-view share.
#pragma once

#include <optional>

#include "cli/options.h"
#include "sh/window.h"

namespace prt {

inline void add_window(cli::Options& app, std::optional<sh::Window>& window) {
  app.add_choice("--window", window, sh::kWindows,
                 "Damps the light's higher bands against ringing, not the background [none]");
}

}  // namespace prt
