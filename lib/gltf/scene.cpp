// Document::scene: the default scene's triangles in world space.
#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/log.h"
#include "gltf/accessor.h"
#include "gltf/geometry.h"
#include "gltf/state.h"

namespace prt::gltf {

namespace {

mesh::Wrap read_wrap(const Json& sampler, const char* key, const Where& where) {
  switch (optional_count(sampler, key, 10497, where)) {
    case 33071:
      return mesh::Wrap::clamp;
    case 33648:
      return mesh::Wrap::mirror;
    default:
      return mesh::Wrap::repeat;
  }
}

class MaterialReader {
 public:
  MaterialReader(const State& state, mesh::Scene& scene)
      : state_(state), scene_(scene), image_of_source_(state.count("images"), -1) {}

  void read_all() {
    for (std::size_t i = 0; i < state_.count("materials"); ++i) {
      scene_.materials.push_back(read(i));
    }
  }

 private:
  mesh::Material read(std::size_t index) {
    const Where where = state_.where("material", index);
    const Json& json = state_.element("materials", index);
    mesh::Material material;
    material.name = optional_string(json, "name", where);
    material.double_sided = optional_bool(json, "doubleSided", where);
    if (const Json* pbr = find(json, "pbrMetallicRoughness")) {
      read_numbers(*pbr, "baseColorFactor", 4, &material.base_color.x, where);
      if (const Json* texture = find(*pbr, "baseColorTexture")) {
        read_texture(*texture, material, where);
      }
    }
    return material;
  }

  void read_texture(const Json& info, mesh::Material& material, const Where& where) {
    const Json& texture =
        state_.element("textures", required_index(info, "index", state_.count("textures"), where));
    if (optional_count(info, "texCoord", 0, where) != 0) {
      log::warning("{}: {}: base colour texture on another set than TEXCOORD_0, ignored",
                   state_.file, where.element);
      return;
    }
    const Json* extensions = find(info, "extensions");
    if (extensions && find(*extensions, "KHR_texture_transform")) {
      log::warning("{}: {}: KHR_texture_transform ignored", state_.file, where.element);
    }
    const auto source = optional_index(texture, "source", state_.count("images"), where);
    if (!source) {
      log::warning("{}: {}: base colour texture in a format of an extension, ignored", state_.file,
                   where.element);
      return;
    }
    material.base_color_image = image_number(*source);
    if (const auto sampler = optional_index(texture, "sampler", state_.count("samplers"), where)) {
      material.wrap_s = read_wrap(state_.element("samplers", *sampler), "wrapS", where);
      material.wrap_t = read_wrap(state_.element("samplers", *sampler), "wrapT", where);
    }
  }

  int image_number(std::size_t source) {
    int& number = image_of_source_[source];
    if (number >= 0) return number;
    const auto view = state_.element("images", source).at("bufferView").get<std::size_t>();
    number = static_cast<int>(scene_.images.size());
    scene_.images.push_back(image::read_image(state_.view_bytes(view),
                                              fmt::format("{}: image {}", state_.file, source),
                                              state_.limits.max_image_pixels));
    return number;
  }

  const State& state_;
  mesh::Scene& scene_;
  std::vector<int> image_of_source_;
};

void move_to_world(mesh::TriangleMesh& mesh, const Matrix4& world_from_local, const Where& where) {
  if (world_from_local == Matrix4()) return;
  const double determinant = Imath::M44d(world_from_local).determinant();
  if (determinant == 0.0 || !std::isfinite(determinant)) {
    throw_bad_input("a transform that flattens the mesh",
                    {.file = where.file, .element = where.element});
  }
  // Normals are moved by the inverse transpose [glTF 2.0 §3.7.2]; what a mirror turns inside out is
  // turned back by exchanging two corners.
  const Matrix4 normal_matrix(Imath::M44d(world_from_local).inverse().transposed());
  for (Vec3& p : mesh.positions) p = transform_point(world_from_local, p);
  for (Vec3& n : mesh.normals) n = transform_vector(normal_matrix, n).normalized();
  for (Vec4& tangent : mesh.tangents) {
    const Vec3 t =
        transform_vector(world_from_local, Vec3(tangent.x, tangent.y, tangent.z)).normalized();
    tangent = Vec4(t.x, t.y, t.z, determinant < 0.0 ? -tangent.w : tangent.w);
  }
  if (determinant > 0.0) return;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  }
}

void check_ready(const State& state, const PrimitiveUse& use, const mesh::TriangleMesh& mesh,
                 const Where& where) {
  const Json& primitive = primitive_of(state, use);
  const auto reject = [&](const char* what) {
    throw_bad_input(what, {.file = where.file,
                           .element = where.element,
                           .advice = "Pass the file through prt-import first."});
  };
  if (primitive_mode(state, primitive) != kTriangles) reject("a strip or fan of triangles");
  if (!primitive.contains("indices")) reject("triangles without indices");
  if (mesh.normals.empty()) reject("a mesh without normals");
  for (const Vec3& p : mesh.positions) {
    if (!is_finite(p)) reject("a position that is not finite");
  }
  for (const Vec3& n : mesh.normals) {
    if (!(std::abs(n.length() - 1.0f) < 0.01f)) reject("a normal that is not of unit length");
  }
}

std::string name_of(const State& state, const PrimitiveUse& use) {
  for (const auto& [array, index] : {std::pair("nodes", use.node), std::pair("meshes", use.mesh)}) {
    std::string name = optional_string(state.element(array, index), "name", {state.file, array});
    if (!name.empty()) return name;
  }
  return fmt::format("mesh {}", use.mesh);
}

}  // namespace

mesh::Scene Document::scene() const {
  mesh::Scene scene;
  std::vector<bool> seen(state_->count("meshes"));
  std::size_t node_before = static_cast<std::size_t>(-1);
  for (const PrimitiveUse& use : list_primitives(*state_)) {
    const Where where{state_->file, fmt::format("mesh {}: primitive {}", use.mesh, use.primitive)};
    if (use.node != node_before && seen[use.mesh]) {
      throw_bad_input("a mesh used by two nodes",
                      {.file = state_->file,
                       .element = fmt::format("mesh {}", use.mesh),
                       .advice = "Pass the file through prt-import first."});
    }
    node_before = use.node;
    seen[use.mesh] = true;
    mesh::Primitive primitive;
    primitive.name = name_of(*state_, use);
    primitive.mesh = read_geometry(*state_, primitive_of(*state_, use), where);
    check_ready(*state_, use, primitive.mesh, where);
    move_to_world(primitive.mesh, use.world_from_local, where);
    const auto material =
        optional_index(primitive_of(*state_, use), "material", state_->count("materials"), where);
    primitive.material = material ? static_cast<int>(*material) : -1;
    primitive.mesh_index = static_cast<int>(use.mesh);
    primitive.primitive_index = static_cast<int>(use.primitive);
    scene.primitives.push_back(std::move(primitive));
  }
  if (scene.triangle_count() == 0) {
    throw_bad_input("no triangles in the default scene", {.file = state_->file});
  }
  MaterialReader(*state_, scene).read_all();
  return scene;
}

}  // namespace prt::gltf
