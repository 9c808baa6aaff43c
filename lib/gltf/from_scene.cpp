// Document::from_scene: a new file of a scene that came from elsewhere.
#include "core/log.h"
#include "gltf/accessor.h"
#include "gltf/geometry.h"
#include "gltf/png.h"

namespace prt::gltf {

namespace {

int wrap_code(mesh::Wrap wrap) {
  switch (wrap) {
    case mesh::Wrap::clamp:
      return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    case mesh::Wrap::mirror:
      return TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    default:
      return TINYGLTF_TEXTURE_WRAP_REPEAT;
  }
}

// Those that materials refer to, which get their new numbers.
void add_images(State& state, const mesh::Scene& scene, std::vector<mesh::Material>& materials) {
  std::vector<int> numbers(scene.images.size(), -1);
  for (mesh::Material& material : materials) {
    if (material.base_color_image < 0) continue;
    const auto image = static_cast<std::size_t>(material.base_color_image);
    if (numbers[image] < 0) {
      const std::size_t view = add_view(state, encode_png(scene.images[image]));
      Json& images = make_array(state.root, "images");
      numbers[image] = static_cast<int>(images.size());
      images.push_back({{"mimeType", "image/png"}, {"bufferView", view}});
    }
    material.base_color_image = numbers[image];
  }
}

Json make_material(State& state, const mesh::Material& material) {
  Json pbr{{"baseColorFactor",
            {material.base_color.x, material.base_color.y, material.base_color.z,
             material.base_color.w}},
           {"metallicFactor", material.metallic},
           {"roughnessFactor", material.roughness}};
  if (material.base_color_image >= 0) {
    Json& samplers = make_array(state.root, "samplers");
    Json& textures = make_array(state.root, "textures");
    samplers.push_back(
        {{"wrapS", wrap_code(material.wrap_s)}, {"wrapT", wrap_code(material.wrap_t)}});
    textures.push_back({{"sampler", samplers.size() - 1}, {"source", material.base_color_image}});
    pbr["baseColorTexture"] = {{"index", textures.size() - 1}};
  }
  Json json = Json::object();
  if (!material.name.empty()) json["name"] = material.name;
  json["pbrMetallicRoughness"] = std::move(pbr);
  if (material.double_sided) json["doubleSided"] = true;
  return json;
}

// The scene's, with the textures that a primitive with texture coordinates shows.
std::vector<mesh::Material> materials_of(const mesh::Scene& scene) {
  std::vector<bool> shown(scene.materials.size());
  for (const mesh::Primitive& primitive : scene.primitives) {
    if (primitive.material < 0 || primitive.mesh.texcoords.empty()) continue;
    shown[static_cast<std::size_t>(primitive.material)] = true;
  }
  std::vector<mesh::Material> materials = scene.materials;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!shown[i]) materials[i].base_color_image = -1;
  }
  return materials;
}

// The primitive's; without texture coordinates, which the texture would need, one more where
// others show it.
int material_of(const mesh::Primitive& primitive, const mesh::Scene& scene,
                std::vector<mesh::Material>& materials) {
  if (primitive.material < 0 || !primitive.mesh.texcoords.empty()) return primitive.material;
  const auto number = static_cast<std::size_t>(primitive.material);
  if (scene.materials[number].base_color_image < 0) return primitive.material;
  log::warning("mesh {}: not all corners have texture coordinates, texture dropped",
               primitive.name);
  if (materials[number].base_color_image < 0) return primitive.material;
  mesh::Material plain = materials[number];
  plain.base_color_image = -1;
  materials.push_back(std::move(plain));
  return static_cast<int>(materials.size()) - 1;
}

void add_primitive(State& state, const mesh::Primitive& primitive, int material) {
  Json json{{"attributes", Json::object()}};
  write_geometry(state, json, primitive.mesh);
  if (material >= 0) json["material"] = material;
  Json& meshes = make_array(state.root, "meshes");
  Json& nodes = make_array(state.root, "nodes");
  Json node{{"mesh", meshes.size()}};
  Json mesh{{"primitives", Json::array({std::move(json)})}};
  if (!primitive.name.empty()) node["name"] = mesh["name"] = primitive.name;
  state.root["scenes"][0]["nodes"].push_back(nodes.size());
  meshes.push_back(std::move(mesh));
  nodes.push_back(std::move(node));
}

}  // namespace

Document Document::from_scene(const mesh::Scene& scene) {
  auto state = std::make_unique<State>();
  state->root = Json::object();
  reserve_keys(state->root);
  state->root["asset"]["version"] = "2.0";
  state->root["scene"] = 0;
  state->root["scenes"][0]["nodes"] = Json::array();
  std::vector<mesh::Material> materials = materials_of(scene);
  for (const mesh::Primitive& primitive : scene.primitives) {
    add_primitive(*state, primitive, material_of(primitive, scene, materials));
  }
  add_images(*state, scene, materials);
  for (const mesh::Material& material : materials) {
    Json json = make_material(*state, material);
    make_array(state->root, "materials").push_back(std::move(json));
  }
  return Document(std::move(state));
}

}  // namespace prt::gltf
