// Document::scene: the default scene's triangles in world space.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/log.h"
#include "gltf/accessor.h"
#include "gltf/geometry.h"
#include "gltf/model.h"

namespace prt::gltf {

namespace {

mesh::Wrap read_wrap(int code) {
  switch (code) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return mesh::Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return mesh::Wrap::mirror;
    default:
      return mesh::Wrap::repeat;
  }
}

// Factors of an extension; a file can hold anything in their place.
class Factors {
 public:
  Factors(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    if (found != extensions.end() && found->second.IsObject()) object_ = &found->second;
  }

  explicit operator bool() const { return object_ != nullptr; }
  bool has(const char* name) const { return object_ && object_->Has(name); }

  float number(const char* name, float fallback, float low, float high) const {
    return has(name) ? limit(object_->Get(name), fallback, low, high) : fallback;
  }

  template <class Vec>
  Vec vector(const char* name, float fallback, float low, float high) const {
    constexpr unsigned kCount = Vec::dimensions();
    Vec vector(fallback);
    if (!has(name)) return vector;
    const tinygltf::Value& list = object_->Get(name);
    for (unsigned c = 0; c < kCount && list.IsArray() && list.ArrayLen() == kCount; ++c) {
      vector[static_cast<int>(c)] = limit(list.Get(c), fallback, low, high);
    }
    return vector;
  }

 private:
  static float limit(const tinygltf::Value& value, float fallback, float low, float high) {
    if (!value.IsNumber()) return fallback;
    return std::clamp(static_cast<float>(value.GetNumberAsDouble()), low, high);
  }

  const tinygltf::Value* object_ = nullptr;
};

void read_reflection(const tinygltf::Material& from, mesh::Material& material) {
  material.metallic =
      std::clamp(static_cast<float>(from.pbrMetallicRoughness.metallicFactor), 0.0f, 1.0f);
  material.roughness =
      std::clamp(static_cast<float>(from.pbrMetallicRoughness.roughnessFactor), 0.0f, 1.0f);
  material.ior = Factors(from.extensions, "KHR_materials_ior").number("ior", 1.5f, 0.0f, 1e6f);
  if (material.ior > 0.0f) material.ior = std::max(material.ior, 1.0f);
  const Factors specular(from.extensions, "KHR_materials_specular");
  material.specular = specular.number("specularFactor", 1.0f, 0.0f, 1.0f);
  material.specular_color = specular.vector<Vec3>("specularColorFactor", 1.0f, 0.0f, 1e6f);
  const Factors anisotropy(from.extensions, "KHR_materials_anisotropy");
  material.has_anisotropy = static_cast<bool>(anisotropy);
  material.anisotropy_strength = anisotropy.number("anisotropyStrength", 0.0f, 0.0f, 1.0f);
  material.anisotropy_rotation = anisotropy.number("anisotropyRotation", 0.0f, -1e3f, 1e3f);
  material.has_unread_textures = specular.has("specularTexture") ||
                                 specular.has("specularColorTexture") ||
                                 anisotropy.has("anisotropyTexture");
}

// KHR_texture_transform: translation · rotation · scale. The rotation is counter-clockwise as seen
// in the image, whose t grows downwards.
mesh::TextureTransform read_transform(const Factors& from) {
  const auto offset = from.vector<Vec2>("offset", 0.0f, -1e6f, 1e6f);
  const auto scale = from.vector<Vec2>("scale", 1.0f, -1e6f, 1e6f);
  const float angle = from.number("rotation", 0.0f, -1e3f, 1e3f);
  const float c = std::cos(angle), s = std::sin(angle);
  return {{c * scale.x, s * scale.y, offset.x}, {-s * scale.x, c * scale.y, offset.y}};
}

class MaterialReader {
 public:
  MaterialReader(const Model& model, mesh::Scene& scene)
      : model_(model),
        scene_(scene),
        images_(model.bufferViews.size(), {-1, -1}),
        pixels_left_(model.state.limits.max_image_pixels) {}

  void read_all() {
    for (std::size_t i = 0; i < model_.materials.size(); ++i) scene_.materials.push_back(read(i));
  }

 private:
  mesh::Material read(std::size_t index) {
    const tinygltf::Material& from = model_.materials[index];
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    mesh::Material material;
    material.name = from.name;
    material.double_sided = from.doubleSided;
    read_reflection(from, material);
    std::copy(pbr.baseColorFactor.begin(), pbr.baseColorFactor.end(), &material.base_color.x);
    const Where where = model_.where("material", index);
    if (from.alphaMode != "OPAQUE") {
      log::warning("{}: {}: alphaMode {} ignored, opaque instead", where.file, where.element,
                   from.alphaMode);
    }
    read_texture(pbr.baseColorTexture, image::Content::colour, "base colour", where,
                 {material.base_color_image, material.wrap_s, material.wrap_t,
                  material.base_color_transform});
    read_texture(pbr.metallicRoughnessTexture, image::Content::data, "metallic-roughness", where,
                 {material.metallic_roughness_image, material.metallic_roughness_wrap_s,
                  material.metallic_roughness_wrap_t, material.metallic_roughness_transform});
    return material;
  }

  /// Where a material keeps a texture.
  struct Texture {
    int& image;
    mesh::Wrap &wrap_s, &wrap_t;
    mesh::TextureTransform& transform;
  };

  void read_texture(const tinygltf::TextureInfo& info, image::Content content, const char* name,
                    const Where& where, const Texture& to) {
    if (info.index < 0) return;
    const auto& texture = model_.textures[static_cast<std::size_t>(info.index)];
    const Factors transform(info.extensions, "KHR_texture_transform");
    if (transform.number("texCoord", static_cast<float>(info.texCoord), 0.0f, 1e6f) != 0.0f) {
      log::warning("{}: {}: {} texture on another set than TEXCOORD_0, ignored", where.file,
                   where.element, name);
      return;
    }
    if (texture.source < 0) {
      log::warning("{}: {}: {} texture in a format of an extension, ignored", where.file,
                   where.element, name);
      return;
    }
    to.image = image_number(static_cast<std::size_t>(texture.source), content);
    to.transform = read_transform(transform);
    if (texture.sampler >= 0) {
      const auto& sampler = model_.samplers[static_cast<std::size_t>(texture.sampler)];
      to.wrap_s = read_wrap(sampler.wrapS);
      to.wrap_t = read_wrap(sampler.wrapT);
    }
  }

  int image_number(std::size_t source, image::Content content) {
    const State& state = model_.state;
    const int view = state.element("images", source).at("bufferView").get<int>();
    int& number =
        images_[static_cast<std::size_t>(view)][content == image::Content::colour ? 0 : 1];
    if (number >= 0) return number;
    number = static_cast<int>(scene_.images.size());
    scene_.images.push_back(image::read_image(model_.view_bytes(view),
                                              fmt::format("{}: image {}", state.file, source),
                                              pixels_left_, content));
    pixels_left_ -= scene_.images.back().pixel_count();
    return number;
  }

  const Model& model_;
  mesh::Scene& scene_;
  std::vector<std::array<int, 2>> images_;  // of each view, as colours and as data
  std::size_t pixels_left_;
};

void move_to_world(mesh::TriangleMesh& mesh, const Matrix4& world_from_local) {
  if (world_from_local == Matrix4()) return;
  // Normals are moved by the inverse transpose [glTF 2.0 §3.7.2]; what a mirror turns inside out is
  // turned back by exchanging two corners.
  const Matrix4 normal_matrix(Imath::M44d(world_from_local).inverse().transposed());
  const bool is_mirror = Imath::M44d(world_from_local).determinant() < 0.0;
  for (Vec3& p : mesh.positions) p = transform_point(world_from_local, p);
  for (Vec3& n : mesh.normals) n = transform_vector(normal_matrix, n).normalized();
  for (Vec4& tangent : mesh.tangents) {
    const Vec3 t =
        transform_vector(world_from_local, Vec3(tangent.x, tangent.y, tangent.z)).normalized();
    tangent = Vec4(t.x, t.y, t.z, is_mirror ? -tangent.w : tangent.w);
  }
  if (!is_mirror) return;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  }
}

// Left at zero, which mesh::frame_at_vertex takes for no tangent.
void drop_bad_tangents(mesh::TriangleMesh& mesh, const Where& where) {
  std::size_t count = 0;
  for (Vec4& tangent : mesh.tangents) {
    const Vec3 direction(tangent.x, tangent.y, tangent.z);
    if (is_finite(tangent) && direction.length() > 0.0f) continue;
    tangent = Vec4(0.0f, 0.0f, 0.0f, 1.0f);
    ++count;
  }
  if (count == 0) return;
  log::warning("{}: {}: {} of {} tangents are zero or not finite, as if these vertices had none",
               where.file, where.element, count, mesh.tangents.size());
}

bool has_unit_normals(const mesh::TriangleMesh& mesh) {
  return std::all_of(mesh.normals.begin(), mesh.normals.end(),
                     [](const Vec3& n) { return std::abs(n.length() - 1.0f) < 0.01f; });
}

void check_ready(const tinygltf::Primitive& primitive, const mesh::TriangleMesh& mesh,
                 const Where& where) {
  const auto reject = [&](const char* what) {
    reject_at(where, what, {}, {}, "Pass the file through prt-import first.");
  };
  if (primitive.mode != TINYGLTF_MODE_TRIANGLES) reject("a strip or fan of triangles");
  if (primitive.indices < 0) reject("triangles without indices");
  if (mesh.normals.empty()) reject("a mesh without normals");
  for (const Vec3& p : mesh.positions) {
    if (!is_finite(p)) reject("a position that is not finite");
  }
  if (!std::all_of(mesh.texcoords.begin(), mesh.texcoords.end(), is_finite<Vec2>)) {
    reject("a texture coordinate that is not finite");
  }
  if (!std::all_of(mesh.colors.begin(), mesh.colors.end(), is_finite<Vec4>)) {
    reject("a colour that is not finite");
  }
  if (!has_unit_normals(mesh)) reject("a normal that is not of unit length");
}

}  // namespace

mesh::Scene Document::scene() const {
  const Model model = read_model(*state_);
  mesh::Scene scene;
  std::vector<bool> seen(model.meshes.size());
  std::size_t node_before = static_cast<std::size_t>(-1);
  for (const PrimitiveUse& use : list_primitives(model)) {
    if (use.node != node_before && seen[use.mesh]) {
      throw_bad_input("a mesh used by two nodes",
                      {.file = state_->file,
                       .element = fmt::format("mesh {}", use.mesh),
                       .advice = "Pass the file through prt-import first."});
    }
    node_before = use.node;
    seen[use.mesh] = true;
    const Where where = where_of(model, use);
    const tinygltf::Primitive& from = primitive_of(model, use);
    mesh::Primitive primitive;
    primitive.name = name_of(model, use);
    primitive.mesh = read_geometry(model, from, where);
    check_ready(from, primitive.mesh, where);
    drop_bad_tangents(primitive.mesh, where);
    check_transform(use.world_from_local, primitive.mesh, where);
    move_to_world(primitive.mesh, use.world_from_local);
    if (!has_unit_normals(primitive.mesh)) {
      reject_at(where, "a transform that leaves a normal without direction");
    }
    primitive.material = from.material;
    primitive.mesh_index = static_cast<int>(use.mesh);
    primitive.primitive_index = static_cast<int>(use.primitive);
    scene.primitives.push_back(std::move(primitive));
  }
  if (scene.triangle_count() == 0) {
    throw_bad_input("no triangles in the default scene", {.file = state_->file});
  }
  MaterialReader(model, scene).read_all();
  return scene;
}

}  // namespace prt::gltf
