// Damping of a band-limited light against ringing: cut off at a band, a small bright light has
// negative radiance around it, and rings of too much.
#pragma once

#include <map>
#include <string>

#include "sh/light.h"

namespace prt::sh {

/// A factor for each band l, which trades sharpness for less ringing [Sloan 2008, Stupid SH
/// Tricks]: Hann's (1 + cos(pi l / band_count)) / 2; Lanczos' sin(pi l / band_count) / (pi l /
/// band_count); or, automatic, exp(-strength l (l + 1)) of the least strength that leaves no more
/// negative than kRinging. That is diffusion, Laplacian damping in infinitely many small steps:
/// heat that flows on the sphere never lowers its minimum, so that the least strength is one
/// number. (One step, 1 / (1 + strength l² (l + 1)²), leaves a sunny map of five bands half of the
/// energy that diffusion leaves for the same minimum, of ten a fifth.)
enum class Window { none, hann, lanczos, automatic };

/// As command lines have them.
inline const std::map<std::string, Window> kWindows = {{"none", Window::none},
                                                       {"hann", Window::hann},
                                                       {"lanczos", Window::lanczos},
                                                       {"auto", Window::automatic}};
const std::string& name_of(Window window);

/// Negative radiance, as a share of a channel's mean, that is too little to see.
constexpr double kRinging = 0.05;

/// Over 16384 fixed directions, evenly spread.
struct Ringing {
  /// Of all directions and channels, the least radiance over the channel's mean; channels without a
  /// positive mean do not count. 1 at most.
  double minimum_over_mean = 1;
  /// Share of the directions where a channel is more than kRinging of its mean below 0.
  double negative_fraction = 0;
};

Ringing ringing_of(const Light& light);

struct WindowedLight {
  Light light;
  Window window = Window::none;
  double strength = 0;  ///< of Window::automatic; 0: the light was left as it is
  Ringing ringing;      ///< that is left
};

/// The mean stays. One strength for all channels, so that colours stay too.
WindowedLight windowed(const Light& light, Window window);

}  // namespace prt::sh
