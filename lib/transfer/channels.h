// How many colour channels a transfer needs.
#pragma once

#include "mesh/scene.h"

namespace prt::transfer {

/// `automatic`: three channels where any albedo is coloured, else one. `one` of a coloured albedo
/// takes its luminance.
enum class ChannelMode { automatic, one, three };

/// 1 or 3. `between_vertices`: whether colours of textures count that no vertex has, as they do
/// where hit points take part.
int choose_channel_count(const mesh::Scene& scene, ChannelMode mode, bool between_vertices);

}  // namespace prt::transfer
