#include "mesh/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/hash.h"

namespace prt::mesh {

namespace {

int wrap_texel(int i, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::clamp:
      return std::clamp(i, 0, size - 1);
    case Wrap::mirror: {
      const int period = ((i % (2 * size)) + 2 * size) % (2 * size);
      return period < size ? period : 2 * size - 1 - period;
    }
    default:
      return ((i % size) + size) % size;
  }
}

// Keeps the texel number of absurd coordinates inside an int; any whole number of mirror periods
// may be dropped.
float reduced(float coordinate, Wrap wrap) {
  if (!std::isfinite(coordinate)) return 0.0f;
  return wrap == Wrap::clamp ? std::clamp(coordinate, -1.0f, 2.0f) : std::fmod(coordinate, 2.0f);
}

Vec3 texel(const image::Image& image, int x, int y) {
  const float* p = image.at(x, y);
  return image.channel_count >= 3 ? Vec3(p[0], p[1], p[2]) : Vec3(p[0]);
}

// Texel centres are at (i + 1/2) / size, as in OpenGL.
Vec3 sample_bilinear(const image::Image& image, const Vec2& texcoord, Wrap wrap_s, Wrap wrap_t) {
  const float x = reduced(texcoord.x, wrap_s) * static_cast<float>(image.width) - 0.5f;
  const float y = reduced(texcoord.y, wrap_t) * static_cast<float>(image.height) - 0.5f;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const int xs[2] = {wrap_texel(x0, image.width, wrap_s), wrap_texel(x0 + 1, image.width, wrap_s)};
  const int ys[2] = {wrap_texel(y0, image.height, wrap_t),
                     wrap_texel(y0 + 1, image.height, wrap_t)};
  const Vec3 upper = texel(image, xs[0], ys[0]) * (1 - fx) + texel(image, xs[1], ys[0]) * fx;
  const Vec3 lower = texel(image, xs[0], ys[1]) * (1 - fx) + texel(image, xs[1], ys[1]) * fx;
  return upper * (1 - fy) + lower * fy;
}

Vec2 transformed(const Vec2& texcoord, const TextureTransform& transform) {
  const Vec3 point(texcoord.x, texcoord.y, 1.0f);
  return {transform.u.dot(point), transform.v.dot(point)};
}

template <class T>
T interpolate(const std::vector<T>& values, const std::array<std::uint32_t, 3>& corners, float u,
              float v, const T& absent) {
  if (values.empty()) return absent;
  return values[corners[0]] * (1 - u - v) + values[corners[1]] * u + values[corners[2]] * v;
}

MetallicRoughness metallic_roughness_at(const Scene& scene, const Primitive& primitive,
                                        const Vec2& texcoord) {
  const Material& material = material_of(scene, primitive);
  MetallicRoughness result{material.metallic, material.roughness};
  if (material.metallic_roughness_image >= 0) {
    const Vec3 texel =
        sample_bilinear(scene.images[static_cast<std::size_t>(material.metallic_roughness_image)],
                        transformed(texcoord, material.metallic_roughness_transform),
                        material.metallic_roughness_wrap_s, material.metallic_roughness_wrap_t);
    result.metallic *= std::clamp(texel.z, 0.0f, 1.0f);
    result.roughness *= std::clamp(texel.y, 0.0f, 1.0f);
  }
  return result;
}

}  // namespace

std::size_t Scene::vertex_count() const {
  std::size_t count = 0;
  for (const Primitive& primitive : primitives) count += primitive.mesh.vertex_count();
  return count;
}

std::size_t Scene::triangle_count() const {
  std::size_t count = 0;
  for (const Primitive& primitive : primitives) count += primitive.mesh.triangle_count();
  return count;
}

std::vector<std::size_t> Scene::vertex_offsets() const {
  std::vector<std::size_t> offsets{0};
  for (const Primitive& primitive : primitives) {
    offsets.push_back(offsets.back() + primitive.mesh.vertex_count());
  }
  return offsets;
}

std::vector<std::uint32_t> Scene::indices() const {
  std::vector<std::uint32_t> all;
  std::uint32_t first = 0;
  for (const Primitive& primitive : primitives) {
    for (const std::uint32_t index : primitive.mesh.indices) all.push_back(first + index);
    first += static_cast<std::uint32_t>(primitive.mesh.vertex_count());
  }
  return all;
}

const Material& default_material() {
  static const Material kDefault = [] {
    Material material;
    material.metallic = material.roughness = 1.0f;
    return material;
  }();
  return kDefault;
}

const Material& material_of(const Scene& scene, const Primitive& primitive) {
  return primitive.material < 0 ? default_material()
                                : scene.materials[static_cast<std::size_t>(primitive.material)];
}

std::string material_name(const Scene& scene, std::size_t index) {
  if (index >= scene.materials.size()) return "no material";
  const std::string& name = scene.materials[index].name;
  return name.empty() ? fmt::format("material {}", index) : name;
}

Vec3 albedo_at(const Scene& scene, const Primitive& primitive, const Vec2& texcoord,
               const Vec4& color) {
  Vec3 albedo(color.x, color.y, color.z);
  if (primitive.material >= 0) {
    const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    albedo *= Vec3(material.base_color.x, material.base_color.y, material.base_color.z);
    if (material.base_color_image >= 0) {
      albedo *= sample_bilinear(scene.images[static_cast<std::size_t>(material.base_color_image)],
                                transformed(texcoord, material.base_color_transform),
                                material.wrap_s, material.wrap_t);
    }
  }
  for (int c = 0; c < 3; ++c) albedo[c] = std::clamp(albedo[c], 0.0f, 1.0f);
  return albedo;
}

Vec3 albedo_at_vertex(const Scene& scene, const Primitive& primitive, std::size_t vertex) {
  const TriangleMesh& mesh = primitive.mesh;
  return albedo_at(scene, primitive, mesh.texcoords.empty() ? Vec2(0.0f) : mesh.texcoords[vertex],
                   mesh.colors.empty() ? Vec4(1.0f) : mesh.colors[vertex]);
}

Vec3 albedo_at_point(const Scene& scene, const Primitive& primitive, std::size_t triangle, float u,
                     float v) {
  const TriangleMesh& mesh = primitive.mesh;
  const auto corners = mesh.triangle(triangle);
  return albedo_at(scene, primitive, interpolate(mesh.texcoords, corners, u, v, Vec2(0.0f)),
                   interpolate(mesh.colors, corners, u, v, Vec4(1.0f)));
}

MetallicRoughness metallic_roughness_at_vertex(const Scene& scene, const Primitive& primitive,
                                               std::size_t vertex) {
  const TriangleMesh& mesh = primitive.mesh;
  return metallic_roughness_at(scene, primitive,
                               mesh.texcoords.empty() ? Vec2(0.0f) : mesh.texcoords[vertex]);
}

MetallicRoughness metallic_roughness_at_point(const Scene& scene, const Primitive& primitive,
                                              std::size_t triangle, float u, float v) {
  const TriangleMesh& mesh = primitive.mesh;
  return metallic_roughness_at(
      scene, primitive, interpolate(mesh.texcoords, mesh.triangle(triangle), u, v, Vec2(0.0f)));
}

namespace {

/// value(0), value(1), … value(count - 1).
template <class T, class Value>
void add_each(Hasher& hasher, std::size_t count, const Value& value) {
  std::vector<T> block;
  for (std::size_t begin = 0; begin < count; begin += block.size()) {
    block.resize(std::min<std::size_t>(count - begin, 4096));
    for (std::size_t i = 0; i < block.size(); ++i) block[i] = value(begin + i);
    hasher.add(std::span<const T>(block));
  }
}

void add_reflection(Hasher& hasher, const Material& m) {
  const float factors[] = {m.ior,
                           m.specular,
                           m.specular_color.x,
                           m.specular_color.y,
                           m.specular_color.z,
                           m.has_anisotropy ? m.anisotropy_strength : 0.0f,
                           m.has_anisotropy ? m.anisotropy_rotation : 0.0f};
  hasher.add(std::span<const float>(factors));
}

/// Before it there were none, only digits. Files keep their hash: what changes mesh_hash needs a
/// new version here, and a test knows the hash of a small scene.
constexpr std::string_view kHashVersion = "2:";

}  // namespace

std::string mesh_hash(const Scene& scene) {
  Hasher hasher;
  for (const Primitive& primitive : scene.primitives) {
    const TriangleMesh& mesh = primitive.mesh;
    const std::uint64_t counts[2] = {mesh.vertex_count(), mesh.triangle_count()};
    hasher.add(std::span<const std::uint64_t>(counts));
    hasher.add(std::span<const Vec3>(mesh.positions));
    hasher.add(std::span<const Vec3>(mesh.normals));
    add_each<Vec3>(hasher, mesh.vertex_count(),
                   [&](std::size_t i) { return albedo_at_vertex(scene, primitive, i); });
    add_each<Vec2>(hasher, mesh.vertex_count(), [&](std::size_t i) {
      const MetallicRoughness at_vertex = metallic_roughness_at_vertex(scene, primitive, i);
      return Vec2(at_vertex.metallic, at_vertex.roughness);
    });
    hasher.add(std::span<const std::uint32_t>(mesh.indices));
    hasher.add(std::span<const Vec4>(mesh.tangents));
    add_reflection(hasher, material_of(scene, primitive));
  }
  return std::string(kHashVersion) + hasher.hex();
}

HashMatch match_mesh_hash(const std::string& hash, const Scene& scene) {
  if (!hash.starts_with(kHashVersion)) return HashMatch::unknown;
  return hash == mesh_hash(scene) ? HashMatch::same : HashMatch::different;
}

std::string scene_hash(const Scene& scene) {
  Hasher hasher;
  const std::string geometry = mesh_hash(scene);
  hasher.add(geometry.data(), geometry.size());
  for (const Primitive& primitive : scene.primitives) {
    hasher.add(std::span<const Vec2>(primitive.mesh.texcoords));
    hasher.add(std::span<const Vec4>(primitive.mesh.colors));
    hasher.add(&primitive.material, sizeof primitive.material);
  }
  for (const Material& material : scene.materials) {
    hasher.add(&material.base_color, sizeof material.base_color);
    const int texture[] = {material.base_color_image,
                           static_cast<int>(material.wrap_s),
                           static_cast<int>(material.wrap_t),
                           material.metallic_roughness_image,
                           static_cast<int>(material.metallic_roughness_wrap_s),
                           static_cast<int>(material.metallic_roughness_wrap_t)};
    hasher.add(texture, sizeof texture);
    hasher.add(&material.base_color_transform, sizeof material.base_color_transform);
    hasher.add(&material.metallic_roughness_transform,
               sizeof material.metallic_roughness_transform);
  }
  for (const image::Image& image : scene.images) {
    const int size[] = {image.width, image.height, image.channel_count};
    hasher.add(size, sizeof size);
    hasher.add(std::span<const float>(image.pixels));
  }
  return hasher.hex();
}

}  // namespace prt::mesh
