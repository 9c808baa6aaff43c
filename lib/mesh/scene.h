// A scene as baking and drawing see it: every mesh primitive of a file in world space, with what
// diffuse shading needs of its material. Vertices of all primitives are also numbered through, in
// order: the transfer signal and its compression use that numbering.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"

namespace prt::mesh {

enum class Wrap { repeat, clamp, mirror };

/// Where a texture is looked up: at (u · (s, t, 1), v · (s, t, 1)) for texture coordinates (s, t).
struct TextureTransform {
  Vec3 u{1.0f, 0.0f, 0.0f}, v{0.0f, 1.0f, 0.0f};
};

/// What a surface reflects, in glTF's terms. Diffuse transfer looks at the base colour only; the
/// rest is for glossy transfer. By default what files without glTF's terms mean: white, matt.
struct Material {
  std::string name;
  Vec4 base_color{1.0f, 1.0f, 1.0f, 1.0f};  ///< linear factor
  int base_color_image = -1;                ///< index into Scene::images, -1: none
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  TextureTransform base_color_transform{};
  bool double_sided = false;
  float metallic = 0.0f, roughness = 1.0f;  ///< factors in [0, 1]
  int metallic_roughness_image = -1;        ///< index into Scene::images, -1: none
  Wrap metallic_roughness_wrap_s = Wrap::repeat, metallic_roughness_wrap_t = Wrap::repeat;
  TextureTransform metallic_roughness_transform{};
  float ior = 1.5f;                       ///< >= 1, or 0 for infinity
  float specular = 1.0f;                  ///< in [0, 1]
  Vec3 specular_color{1.0f, 1.0f, 1.0f};  ///< >= 0
  bool has_anisotropy = false;
  float anisotropy_strength = 0.0f;  ///< in [0, 1]
  float anisotropy_rotation = 0.0f;  ///< radians, counter-clockwise from the tangent
  bool has_unread_textures = false;  ///< of specular and anisotropy
};

struct Primitive {
  std::string name;                         ///< of the node or mesh, for messages and reports
  TriangleMesh mesh;                        ///< world space; normals always present
  int material = -1;                        ///< index into Scene::materials, -1: default_material()
  int mesh_index = 0, primitive_index = 0;  ///< where it stands in the glTF file
};

struct Scene {
  std::vector<Primitive> primitives;
  std::vector<Material> materials;
  std::vector<image::Image> images;  ///< textures, linear: colours, or metallic and roughness

  std::size_t vertex_count() const;
  std::size_t triangle_count() const;
  /// Number of the first vertex of each primitive, and the total at the end.
  std::vector<std::size_t> vertex_offsets() const;
  /// Triangles of all primitives, three indices each, of vertices numbered through.
  std::vector<std::uint32_t> indices() const;
};

/// Of a primitive without a material, as glTF 2.0 §3.9 has it: white, metallic 1, roughness 1.
const Material& default_material();
const Material& material_of(const Scene& scene, const Primitive& primitive);
/// For messages and reports: its name, or its number in the file. Past the end, of none.
std::string material_name(const Scene& scene, std::size_t index);

/// Diffuse albedo (linear RGB, clamped to [0, 1]): factor × vertex colour × texture, bilinear.
Vec3 albedo_at(const Scene& scene, const Primitive& primitive, const Vec2& texcoord,
               const Vec4& color);
Vec3 albedo_at_vertex(const Scene& scene, const Primitive& primitive, std::size_t vertex);
/// At the point of a triangle with barycentric weights (1-u-v, u, v).
Vec3 albedo_at_point(const Scene& scene, const Primitive& primitive, std::size_t triangle, float u,
                     float v);

/// Factor × texture (blue: metallic, green: roughness; glTF 2.0 §3.9.2), bilinear, in [0, 1].
struct MetallicRoughness {
  float metallic, roughness;
};
MetallicRoughness metallic_roughness_at_vertex(const Scene& scene, const Primitive& primitive,
                                               std::size_t vertex);
/// At the point of a triangle with barycentric weights (1-u-v, u, v).
MetallicRoughness metallic_roughness_at_point(const Scene& scene, const Primitive& primitive,
                                              std::size_t triangle, float u, float v);

/// Content hash of what a transfer, diffuse or glossy, is baked from and belongs to: positions,
/// normals, tangents, indices and what the vertices reflect by, of all primitives. Of textures,
/// what lies between the vertices is left out. "2:" and 32 hexadecimal digits: the number before
/// the colon is the version of the recipe, and rises with every change of what is hashed or how.
std::string mesh_hash(const Scene& scene);

enum class HashMatch {
  same,
  different,  ///< geometry or reflection changed
  unknown,    ///< no hash, or one by a recipe that is not mesh_hash's: nothing can be said
};
/// Whether `hash`, as a file holds it, is that of the scene.
HashMatch match_mesh_hash(const std::string& hash, const Scene& scene);

/// Content hash of all that light meets in the scene: that, and the textures between the vertices.
std::string scene_hash(const Scene& scene);

}  // namespace prt::mesh
