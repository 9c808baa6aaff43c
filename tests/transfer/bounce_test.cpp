#include <gtest/gtest.h>

#include "transfer/directions.h"
#include "transfer/scenes.h"

namespace prt::transfer {
namespace {

using Vec3d = Imath::V3d;

/// Inside of the lower half of a sphere.
TriangleMesh bowl(int level) { return turned_inside_out(sphere(level, true)); }

TEST(Bounce, WhiteBowlShowsConstantLightEverywhere) {
  const mesh::Scene scene = scene_of(bowl(3));
  const auto direct = compute(scene, {.ray_count = 512});
  const auto bounced = compute(scene, {.ray_count = 512, .bounce_count = 40});
  double darkest = 1.0;
  for (std::size_t v = 0; v < scene.vertex_count(); ++v) {
    darkest = std::min(darkest, under_constant_light(direct, v));
    EXPECT_NEAR(under_constant_light(bounced, v), 1.0, 1e-3) << v;
  }
  EXPECT_LT(darkest, 0.6);
}

// In a hemispherical bowl of albedo a every point sees the same share of the opening, 1/2 by area
// of sphere and disk, so E = pi/2 + a E/2 however many bounces: exit radiance a/2 / (1 - a/2).
TEST(Bounce, GrayBowlMatchesTheIntegratingSphere) {
  for (float albedo : {0.3f, 0.7f}) {
    mesh::Scene scene;
    add(scene, bowl(4), Vec3(albedo));
    const auto direct = compute(scene, {.ray_count = 1024});
    const auto bounced = compute(scene, {.ray_count = 1024, .bounce_count = 16});
    for (std::size_t v = 0; v < scene.vertex_count(); ++v) {
      if (scene.primitives[0].mesh.positions[v].y > -0.1f) continue;  // the rim is a polygon
      EXPECT_NEAR(under_constant_light(direct, v), albedo / 2, 0.015);
      EXPECT_NEAR(under_constant_light(bounced, v), albedo / 2 / (1 - albedo / 2), 0.015);
    }
  }
}

TEST(Bounce, ClosedRoomStaysDarkAndIsNotBuried) {
  mesh::Scene scene;
  add(scene, turned_inside_out(sphere(3)), Vec3(1.0f));
  DiffuseStats stats;
  const auto signal = compute_diffuse(scene, {.bounce_count = 8}, stats);
  EXPECT_EQ(stats.buried_vertex_count, 0u);
  for (float value : signal.values) EXPECT_NEAR(value, 0.0f, 5e-3f);
}

TEST(Bounce, EachAddsLightAndNoneAddsTooMuch) {
  const mesh::Scene scene = coloured_box(6);
  std::vector<double> last(scene.vertex_count(), 0.0);
  for (int bounces : {0, 1, 2, 6, 30}) {
    const auto signal = compute(scene, {.ray_count = 512, .bounce_count = bounces});
    ASSERT_EQ(signal.channel_count, 3);
    for (std::size_t v = 0; v < scene.vertex_count(); ++v) {
      const double radiance = under_constant_light(signal, v, 1);
      EXPECT_GE(radiance, last[v] - 1e-5);
      EXPECT_LE(radiance, 0.76);
      last[v] = radiance;
    }
  }
}

TEST(Bounce, ColouredWallsBleed) {
  const std::uint32_t n = 6;
  const mesh::Scene scene = coloured_box(n);
  const auto direct = compute(scene, {.ray_count = 512});
  const auto bounced = compute(scene, {.ray_count = 512, .bounce_count = 2});
  const std::size_t by_red = 3 * (n + 1), by_green = 3 * (n + 1) + n;  // floor, middle row
  EXPECT_NEAR(under_constant_light(direct, by_red, 0), under_constant_light(direct, by_red, 1),
              1e-6);
  EXPECT_GT(under_constant_light(bounced, by_red, 0),
            1.2 * under_constant_light(bounced, by_red, 1));
  EXPECT_GT(under_constant_light(bounced, by_green, 1),
            1.2 * under_constant_light(bounced, by_green, 0));
}

TEST(Bounce, ChannelsFollowTheColours) {
  const mesh::Scene coloured = coloured_box(2), gray = scene_of(bowl(1));
  EXPECT_EQ(compute(gray, {.ray_count = 16}).channel_count, 1);
  EXPECT_EQ(compute(gray, {.ray_count = 16, .channels = ChannelMode::three}).channel_count, 3);
  const auto one = compute(coloured, {.ray_count = 16, .channels = ChannelMode::one});
  EXPECT_EQ(one.channel_count, 1);
  // Vertex 0 of the red wall has the luminance of its albedo.
  const auto three = compute(coloured, {.ray_count = 16});
  const std::size_t v = 3 * 9;
  const double luminance = 0.2126 * 0.8 + 0.7152 * 0.1 + 0.0722 * 0.1;
  EXPECT_NEAR(under_constant_light(one, v) / under_constant_light(three, v), luminance / 0.8, 1e-4);
}

TEST(Bounce, TextureIsTakenAtTheHitPoint) {
  // One quad over the floor, its texture red where the floor's rays hit it, black at its corners.
  mesh::Scene scene = scene_of(grid({-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}, 2));
  TriangleMesh roof = grid({-4, 1, -4}, {8, 0, 0}, {0, 0, 8}, 1);
  roof.texcoords = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  add(scene, roof);
  image::Image image(8, 8, 3);
  for (int y = 2; y < 6; ++y) {
    for (int x = 2; x < 6; ++x) image.at(x, y)[0] = 1.0f;
  }
  scene.images.push_back(image);
  scene.materials[1].base_color_image = 0;
  scene.materials[1].wrap_s = scene.materials[1].wrap_t = mesh::Wrap::clamp;
  const auto direct =
      compute(scene, {.band_count = 2, .ray_count = 512, .channels = ChannelMode::three});
  const auto bounced = compute(scene, {.band_count = 2, .ray_count = 512, .bounce_count = 1});
  ASSERT_EQ(bounced.channel_count, 3);
  // Light from below (-y, the roof's front): Y(1,-1) = -0.4886 y reflects off the roof in red
  // alone.
  const std::size_t middle = 4;
  EXPECT_GT(row(bounced, middle)[1] - row(direct, middle)[1], 0.1f);
  EXPECT_NEAR(row(bounced, middle)[5] - row(direct, middle)[5], 0.0f, 1e-6f);
}

TEST(Bounce, MemoryBudgetsChangeNothing) {
  const mesh::Scene scene = coloured_box(4);
  DiffuseOptions options{.ray_count = 256, .bounce_count = 3};
  DiffuseStats roomy, tight;
  const auto expected = compute_diffuse(scene, options, roomy);
  options.hit_bytes = 0;
  options.bounce_bytes = 20000;
  const auto signal = compute_diffuse(scene, options, tight);
  EXPECT_EQ(signal.values, expected.values);
  EXPECT_GT(tight.rays_cast, 2 * roomy.rays_cast);
}

// The definition in transfer/diffuse.h, in double precision, a ray at a time against every
// triangle.
class PlainTransfer {
 public:
  PlainTransfer(const mesh::Scene& scene, int ray_count)
      : scene_(scene), directions_(make_directions(2 * static_cast<std::size_t>(ray_count), 1)) {
    for (const mesh::Primitive& primitive : scene.primitives) {
      const auto offset = static_cast<std::uint32_t>(positions_.size());
      for (std::size_t v = 0; v < primitive.mesh.vertex_count(); ++v) {
        positions_.push_back(Vec3d(primitive.mesh.positions[v]));
        normals_.push_back(Vec3d(primitive.mesh.normals[v]));
        albedos_.push_back(Vec3d(mesh::albedo_at_vertex(scene, primitive, v)));
      }
      for (std::uint32_t i : primitive.mesh.indices) indices_.push_back(i + offset);
    }
    inward_.resize(positions_.size(), Vec3d(0.0));
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      const std::uint32_t* corners = &indices_[i / 3 * 3];
      const Vec3d sum = positions_[corners[0]] + positions_[corners[1]] + positions_[corners[2]];
      inward_[indices_[i]] += (sum / 3.0 - positions_[indices_[i]]).normalized();
    }
  }

  /// Rows of 3 × 25, as the signal's.
  std::vector<double> run(int bounce_count) const {
    const std::size_t count = positions_.size();
    std::vector<std::vector<Found>> found(count);
    std::vector<double> field(count * 75);
    std::vector<float> y(25);
    for (std::size_t v = 0; v < count; ++v) {
      double blocked = std::numbers::pi;
      for (std::size_t d = 0; d < directions_.count(); ++d) {
        const Vec3d direction(directions_[d]);
        const double cosine = normals_[v].dot(direction);
        if (cosine <= 0.0) continue;
        const Found hit =
            closest(v, direction,
                    cosine * 4.0 * std::numbers::pi / static_cast<double>(directions_.count()));
        if (hit.triangle != kNone) {
          found[v].push_back(hit);
          continue;
        }
        blocked -= hit.weight;
        sh::evaluate(5, directions_[d], y);
        for (std::size_t j = 0; j < 75; ++j) field[v * 75 + j] += hit.weight * y[j % 25];
      }
      scale_to(blocked, found[v]);
    }
    std::vector<double> total = field;
    for (int b = 0; b < bounce_count; ++b) {
      std::vector<double> next(field.size());
      for (std::size_t v = 0; v < count; ++v) {
        for (const Found& hit : found[v]) gather(hit, field, &next[v * 75]);
      }
      field = next;
      for (std::size_t i = 0; i < total.size(); ++i) total[i] += field[i];
    }
    for (std::size_t i = 0; i < total.size(); ++i) {
      total[i] *= albedos_[i / 75][static_cast<int>(i % 75 / 25)] / std::numbers::pi;
    }
    return total;
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  struct Found {
    std::size_t triangle = kNone;
    double t = INFINITY, u = 0, v = 0, weight = 0;
    bool back_face = false;
  };

  static void scale_to(double blocked, std::vector<Found>& hits) {
    double sum = 0.0;
    for (const Found& hit : hits) sum += hit.weight;
    for (Found& hit : hits) hit.weight *= blocked / sum;
  }

  Found closest(std::size_t vertex, const Vec3d& d, double weight) const {
    Found best;
    best.weight = weight;
    const Vec3d origin = positions_[vertex] + normals_[vertex] * 1e-6 + inward_[vertex] * 1e-6;
    for (std::size_t i = 0; i < indices_.size() / 3; ++i) {
      const Vec3d p0 = positions_[indices_[3 * i]];
      const Vec3d e1 = positions_[indices_[3 * i + 1]] - p0,
                  e2 = positions_[indices_[3 * i + 2]] - p0;
      const double determinant = e1.dot(d.cross(e2));
      if (determinant == 0.0) continue;
      const Vec3d s = origin - p0;
      const double u = s.dot(d.cross(e2)) / determinant, v = d.dot(s.cross(e1)) / determinant;
      const double t = e2.dot(s.cross(e1)) / determinant;
      if (std::min({u, v, 1 - u - v}) < -1e-9 || t <= 0.0 || t >= best.t) continue;
      best = {i, t, u, v, weight, determinant < 0.0};
    }
    return best;
  }

  void gather(const Found& hit, const std::vector<double>& field, double* sum) const {
    if (hit.back_face) return;
    const std::uint32_t* corners = &indices_[3 * hit.triangle];
    const double barycentric[] = {1 - hit.u - hit.v, hit.u, hit.v};
    for (int k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 75; ++j) {
        sum[j] += hit.weight * barycentric[k] * albedos_[corners[0]][static_cast<int>(j / 25)] /
                  std::numbers::pi * field[corners[k] * 75 + j];
      }
    }
  }

  const mesh::Scene& scene_;
  Directions directions_;
  std::vector<Vec3d> positions_, normals_, albedos_, inward_;
  std::vector<std::uint32_t> indices_;
};

TEST(Bounce, AgreesWithAPlainImplementation) {
  mesh::Scene scene = coloured_box(3);
  add(scene, box({-0.4f, -0.9f, -0.5f}, {0.3f, -0.1f, 0.2f}, 1), Vec3(0.9f, 0.6f, 0.3f));
  for (int bounces : {0, 1, 3}) {
    const auto signal = compute(
        scene,
        {.ray_count = 128, .bounce_count = bounces, .bounce_ray_count = 128, .closed_form = false});
    const std::vector<double> plain = PlainTransfer(scene, 128).run(bounces);
    ASSERT_EQ(signal.values.size(), plain.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      different += std::abs(signal.values[i] - plain[i]) > 1e-4;
      // A ray that grazes an edge may go either way; it weighs 4 pi / 256 · Y / pi at most.
      EXPECT_NEAR(signal.values[i], plain[i], 0.04) << i;
    }
    // Three vertices have rays along edges of the boxes that the last bit decides, single precision
    // otherwise than double.
    EXPECT_LE(different, 3u * 75u);
  }
}

}  // namespace
}  // namespace prt::transfer
