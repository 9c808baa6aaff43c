#include "transfer/channels.h"

#include <algorithm>

namespace prt::transfer {

namespace {

bool is_coloured(const Vec3& albedo) { return albedo.x != albedo.y || albedo.y != albedo.z; }

bool is_coloured(const image::Image& image) {
  if (image.channel_count < 3) return false;
  const auto step = static_cast<std::size_t>(image.channel_count);
  for (std::size_t i = 0; i + 2 < image.pixels.size(); i += step) {
    if (is_coloured(Vec3(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]))) return true;
  }
  return false;
}

}  // namespace

int choose_channel_count(const mesh::Scene& scene, ChannelMode mode, bool between_vertices) {
  if (mode != ChannelMode::automatic) return mode == ChannelMode::three ? 3 : 1;
  for (const mesh::Primitive& primitive : scene.primitives) {
    for (std::size_t v = 0; v < primitive.mesh.vertex_count(); ++v) {
      if (is_coloured(mesh::albedo_at_vertex(scene, primitive, v))) return 3;
    }
  }
  const auto has_coloured_texture = [&](const mesh::Material& material) {
    return material.base_color_image >= 0 &&
           is_coloured(scene.images[static_cast<std::size_t>(material.base_color_image)]);
  };
  const bool textured =
      between_vertices &&
      std::any_of(scene.materials.begin(), scene.materials.end(), has_coloured_texture);
  return textured ? 3 : 1;
}

}  // namespace prt::transfer
