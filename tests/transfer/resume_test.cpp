// A bake that was interrupted, and goes on.
#include "transfer/resume.h"

#include <gtest/gtest.h>

#include "core/file.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "transfer/matrix.h"

namespace prt::transfer {
namespace {

namespace fs = std::filesystem;

class ResumeTest : public testing::Test {
 protected:
  ResumeTest() {
    options_.checkpoint = {path_, 0.0};
    expected_ = compute_diffuse(scene_, options_, whole_);
    kept_ = read_text_file(path_);
  }
  /// Bakes beside what is left of the file; the values must be those of the whole run.
  DiffuseStats bake(const std::string& left) const {
    folder_.write("out.partial", left);
    return bake(options_);
  }
  DiffuseStats bake(const DiffuseOptions& options) const {
    DiffuseStats stats;
    const auto signal = compute_diffuse(scene_, options, stats);
    EXPECT_EQ(signal.values, expected_.values);
    EXPECT_EQ(stats.buried_vertex_count, whole_.buried_vertex_count);
    return stats;
  }

  const TemporaryFolder folder_;
  const fs::path path_ = folder_ / "out.partial";
  const mesh::Scene scene_ = coloured_box(6);
  DiffuseOptions options_{.band_count = 4, .ray_count = 64, .bounce_count = 2};
  DiffuseStats whole_;
  signal::TransferSignal expected_;
  std::string kept_;
};

TEST_F(ResumeTest, WithoutACheckpointTheValuesAreTheSame) {
  DiffuseOptions options = options_;
  options.checkpoint = {};
  EXPECT_EQ(bake(options).rays_cast, whole_.rays_cast);
}

TEST_F(ResumeTest, ContinuesFromAnyPoint) {
  std::uint64_t rays = whole_.rays_cast + 1;
  for (std::size_t step = 0; step <= 8; ++step) {
    const DiffuseStats stats = bake(kept_.substr(0, kept_.size() * step / 8));
    EXPECT_LE(stats.rays_cast, rays);
    rays = stats.rays_cast;
    EXPECT_EQ(read_text_file(path_).size(), kept_.size());
  }
  const DiffuseStats all = bake(kept_);
  EXPECT_EQ(all.resumed_vertex_count, expected_.vertex_count());
  EXPECT_LT(all.rays_cast, whole_.rays_cast);
}

TEST_F(ResumeTest, ContinuesInTheMiddleOfTheBounces) {
  options_.bounce_bytes = 20000;  // several groups of coefficients
  fs::remove(path_);
  bake(options_);
  kept_ = read_text_file(path_);
  for (const std::size_t cut : {50u, 20000u, 40000u}) {
    EXPECT_EQ(bake(kept_.substr(0, kept_.size() - cut)).resumed_vertex_count,
              expected_.vertex_count());
  }
}

TEST_F(ResumeTest, DamageIsComputedAnew) {
  for (std::size_t at = 100; at < kept_.size(); at += kept_.size() / 20) {
    std::string damaged = kept_;
    damaged[at] = static_cast<char>(~damaged[at]);
    bake(damaged);
  }
}

TEST_F(ResumeTest, OtherOptionsOrAnotherSceneStartAnew) {
  const auto resumed = [&](const mesh::Scene& scene, const DiffuseOptions& options) {
    folder_.write("out.partial", kept_);
    DiffuseStats stats, fresh;
    DiffuseOptions alone = options;
    alone.checkpoint = {};
    EXPECT_EQ(compute_diffuse(scene, options, stats).values,
              compute_diffuse(scene, alone, fresh).values);
    return stats.resumed_vertex_count;
  };
  EXPECT_GT(resumed(scene_, options_), 0u);
  DiffuseOptions options = options_;
  options.seed = 2;
  EXPECT_EQ(resumed(scene_, options), 0u);
  options = options_;
  options.ray_count = 65;
  EXPECT_EQ(resumed(scene_, options), 0u);
  options = options_;
  options.bounce_count = 3;
  EXPECT_EQ(resumed(scene_, options), 0u);
  mesh::Scene scene = scene_;
  scene.primitives[0].mesh.positions[0].x += 0.01f;
  EXPECT_EQ(resumed(scene, options_), 0u);
}

TEST(MatrixResume, ContinuesFromAnyPoint) {
  const TemporaryFolder folder;
  const mesh::Scene scene = coloured_box(6);
  MatrixOptions options{.brdf = "lambert", .band_count = 2, .row_count = 4, .ray_count = 64};
  DiffuseStats whole;
  const auto expected = compute_matrices(scene, options, whole);
  options.checkpoint = {folder / "out.partial", 0.0};
  DiffuseStats first;
  compute_matrices(scene, options, first);
  const std::string kept = read_text_file(folder / "out.partial");
  std::size_t resumed = 0;
  for (std::size_t step = 0; step <= 3; ++step) {
    folder.write("out.partial", kept.substr(0, kept.size() * step / 3));
    DiffuseStats stats;
    EXPECT_EQ(compute_matrices(scene, options, stats).values, expected.values);
    EXPECT_GE(stats.resumed_vertex_count, resumed);
    resumed = stats.resumed_vertex_count;
  }
  EXPECT_EQ(resumed, expected.vertex_count());
}

}  // namespace
}  // namespace prt::transfer
