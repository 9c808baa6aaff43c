#include "brdf/scene_material.h"

namespace prt::brdf {

MetallicRoughness metallic_roughness(const mesh::Material& material) {
  return {.metallic = double{material.metallic},
          .roughness = double{material.roughness},
          .ior = double{material.ior},
          .specular = double{material.specular},
          .specular_color = Colour(material.specular_color),
          .has_anisotropy = material.has_anisotropy,
          .anisotropy_strength = double{material.anisotropy_strength},
          .anisotropy_rotation = double{material.anisotropy_rotation}};
}

}  // namespace prt::brdf
