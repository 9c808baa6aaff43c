#include "transfer/scene_index.h"

#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/spatial_order.h"
#include "ray/wide_engine.h"

namespace prt::transfer {

namespace {

// Mean of the unit vectors from a vertex to the middles of its triangles, along the surface: about
// 0.6 at the edge of a regular grid, more at its corner, 0 inside. Below this it is not an edge.
constexpr float kEdgeShift = 0.25f;

// A beam of the shadow tree looks into every box that it meets. Its lead over the engine, 1.8 times
// at 70 triangles a ray, is gone at 270.
constexpr std::size_t kMostTrianglesPerRay = 200;

float largest_coordinate(const Vec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

void check_vertices(const mesh::Primitive& primitive) {
  const mesh::TriangleMesh& mesh = primitive.mesh;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    if (is_finite(mesh.positions[i]) && is_finite(mesh.normals[i]) &&
        (mesh.colors.empty() || is_finite(mesh.colors[i]))) {
      continue;
    }
    throw_bad_input("position, normal or colour is not finite",
                    {.element = fmt::format("{}, vertex {}", primitive.name, i)});
  }
}

}  // namespace

SceneIndex::SceneIndex(const mesh::Scene& scene, const ScratchOptions& scratch)
    : scene_(scene), vertex_offsets_{0}, triangle_offsets_{0} {
  Imath::Box3f box;
  for (const mesh::Primitive& primitive : scene.primitives) {
    check_vertices(primitive);
    for (const Vec3& p : primitive.mesh.positions) box.extendBy(p);
    vertex_offsets_.push_back(vertex_count() + primitive.mesh.vertex_count());
    triangle_offsets_.push_back(triangle_count() + primitive.mesh.triangle_count());
  }
  if (std::max(vertex_count(), triangle_count()) >= ray::kNoHit) {
    throw_failed("too many vertices or triangles", {.expected = "fewer than 2^32 - 1"});
  }
  if (vertex_count() > 0) centre_ = box.min * 0.5f + box.max * 0.5f;
  if (vertex_count() > 0)
    scale_ = ray::unit_scale(largest_coordinate(box.max * 0.5f - box.min * 0.5f));

  for (const mesh::Primitive& primitive : scene.primitives) {
    ray::check_indices(primitive.mesh.indices, primitive.mesh.vertex_count());
  }
  if (vertex_count() > scratch.in_memory_vertices) scratch_folder_ = scratch.folder;
  const SpatialGrid grid(vertex_count(), [&](std::size_t v) { return position(v); });
  vertex_order_ = spatial_order(
      grid, vertex_count(), [&](std::size_t v) { return position(v); }, scratch_folder_);
  find_ray_origins(grid);
}

ray::TriangleSource SceneIndex::triangle_source() const {
  return {triangle_count(), [this](std::size_t t) {
            const Place at = triangle_place(t);
            const mesh::TriangleMesh& mesh = scene_.primitives[at.primitive].mesh;
            const std::uint32_t* corner = &mesh.indices[3 * at.local];
            return std::array{traced(mesh.positions[corner[0]]), traced(mesh.positions[corner[1]]),
                              traced(mesh.positions[corner[2]])};
          }};
}

std::unique_ptr<ray::Engine> SceneIndex::make_embree_engine() const {
  std::vector<Vec3> positions(vertex_count());
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = position(v);
  return ray::make_embree_engine({positions, scene_.indices()});
}

const std::shared_ptr<const ray::WideTree>& SceneIndex::wide_tree() const {
  std::call_once(wide_tree_once_, [&] {
    wide_tree_ = std::make_shared<ray::WideTree>(triangle_source(),
                                                 ray::WideTreeOptions{.folder = scratch_folder_});
  });
  return wide_tree_;
}

const ray::Engine& SceneIndex::engine() const {
  std::call_once(engine_once_, [&] {
    engine_ = is_large() ? ray::make_wide_engine(wide_tree()) : make_embree_engine();
  });
  return *engine_;
}

const ray::ShadowTree* SceneIndex::shadow_tree() const {
  if (prefers_engine_) return nullptr;
  std::call_once(shadow_tree_once_,
                 [&] { shadow_tree_ = std::make_unique<ray::ShadowTree>(wide_tree()); });
  return shadow_tree_.get();
}

void SceneIndex::build_for_shadow_rays(int ray_count) {
  prefers_engine_ = triangle_count() > kMostTrianglesPerRay * static_cast<std::size_t>(ray_count);
  if (prefers_engine_) {
    engine();
  } else {
    shadow_tree();
  }
}

void SceneIndex::find_ray_origins(const SpatialGrid& grid) {
  MappedArray<Surroundings> around(vertex_count(), scratch_folder_);
  add_triangles(around);
  share_between_equals(grid, around);
  magnitudes_ = MappedArray<float>(vertex_count(), scratch_folder_);
  ray_origins_ = MappedArray<Vec3>(vertex_count(), scratch_folder_);
  for_each_trimmed(vertex_count(), [&](std::size_t v) {
    const Vec4& inward = around[v].inward;
    const Vec3 n = normal(v);
    const Vec3 mean = Vec3(inward.x, inward.y, inward.z) / std::max(1.0f, inward.w);
    Vec3 tangential = mean - n * n.dot(mean);
    if (tangential.length() < kEdgeShift) tangential = Vec3(0.0f);
    magnitudes_[v] = around[v].magnitude;
    ray_origins_[v] = ray::offset_origin(position(v), n + tangential, magnitudes_[v]);
  });
}

void SceneIndex::add_triangles(MappedArray<Surroundings>& around) const {
  for_each_trimmed(triangle_count(), [&](std::size_t t) {
    const std::array<std::uint32_t, 3> corners = triangle(t);
    const Vec3 a = position(corners[0]), b = position(corners[1]), c = position(corners[2]);
    const Vec3 middle = a / 3.0f + b / 3.0f + c / 3.0f;
    const float largest =
        std::max({largest_coordinate(a), largest_coordinate(b), largest_coordinate(c)});
    for (std::uint32_t k : corners) {
      Surroundings& at = around[k];
      at.magnitude = std::max(at.magnitude, largest);
      const Vec3 towards = (middle - position(k)).normalized();
      at.inward += Vec4(towards.x, towards.y, towards.z, 1.0f);
    }
  });
}

// Equals lie in one cell of the spatial order: only its runs of vertices in about the same place
// need sorting, which mostly are single vertices.
void SceneIndex::share_between_equals(const SpatialGrid& grid,
                                      MappedArray<Surroundings>& around) const {
  const auto key = [&](std::uint32_t v) {
    const Vec3 p = position(v), &n = normal(v);
    return std::array<float, 6>{p.x, p.y, p.z, n.x, n.y, n.z};
  };
  const auto share = [&](std::span<const std::uint32_t> equals) {
    Surroundings sum;
    for (const std::uint32_t v : equals) {
      sum.inward += around[v].inward;
      sum.magnitude = std::max(sum.magnitude, around[v].magnitude);
    }
    for (const std::uint32_t v : equals) around[v] = sum;
    trim_mapped_arrays();
  };
  const auto cell = [&](std::size_t place) { return grid.cell(position(vertex_order_[place])); };
  std::vector<std::uint32_t> run;
  std::size_t begin = 0;  // of a run
  for_each_trimmed(vertex_count(), [&](std::size_t place) {
    const std::size_t end = place + 1;
    if (end < vertex_count() && cell(end) == cell(place)) return;
    run.assign(vertex_order_.begin() + begin, vertex_order_.begin() + end);
    begin = end;
    if (run.size() == 1) return;
    std::sort(run.begin(), run.end(), [&](std::uint32_t a, std::uint32_t b) {
      const auto ka = key(a), kb = key(b);
      return ka != kb ? ka < kb : a < b;
    });
    for (std::size_t i = 0, next = 0; i < run.size(); i = next) {
      for (next = i + 1; next < run.size() && key(run[next]) == key(run[i]);) ++next;
      if (next - i > 1) share(std::span(run).subspan(i, next - i));
    }
  });
}

SceneIndex::Place SceneIndex::place(const std::vector<std::size_t>& offsets, std::size_t number) {
  const auto next = std::upper_bound(offsets.begin(), offsets.end(), number);
  const auto primitive = static_cast<std::size_t>(next - offsets.begin()) - 1;
  return {primitive, number - offsets[primitive]};
}

const Vec3& SceneIndex::normal(std::size_t vertex) const {
  const Place at = vertex_place(vertex);
  return scene_.primitives[at.primitive].mesh.normals[at.local];
}

Vec3 SceneIndex::position(std::size_t vertex) const {
  const Place at = vertex_place(vertex);
  return traced(scene_.primitives[at.primitive].mesh.positions[at.local]);
}

std::array<std::uint32_t, 3> SceneIndex::triangle(std::size_t triangle) const {
  const Place at = triangle_place(triangle);
  std::array<std::uint32_t, 3> corners = scene_.primitives[at.primitive].mesh.triangle(at.local);
  for (std::uint32_t& i : corners) i += static_cast<std::uint32_t>(vertex_offsets_[at.primitive]);
  return corners;
}

}  // namespace prt::transfer
