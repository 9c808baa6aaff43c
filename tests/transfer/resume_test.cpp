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

TEST_F(ResumeTest, ContinuesALargeScene) {
  options_.scratch = {.folder = folder_.path(), .in_memory_vertices = 0};
  fs::remove(path_);
  DiffuseOptions plain = options_;
  plain.checkpoint = {};
  DiffuseStats stats;
  expected_ = compute_diffuse(scene_, plain, stats);
  bake(options_);
  kept_ = read_text_file(path_);
  for (const std::size_t cut : {0u, 50u, 200'000u}) bake(kept_.substr(0, kept_.size() - cut));
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

/// Asks for the matrices of a scene in three blocks, as a file does, and stops before the given
/// one.
std::vector<float> matrices(const mesh::Scene& scene, const MatrixOptions& options,
                            DiffuseStats& stats, std::size_t block_count = 3) {
  MatrixTransfer transfer(scene, options, stats);
  const std::size_t count = transfer.header().vertex_count(), block = (count + 2) / 3;
  const auto dimension = static_cast<std::size_t>(transfer.header().dimension());
  std::vector<float> values(count * dimension);
  for (std::size_t b = 0; b < block_count; ++b) {
    const std::size_t first = b * block, size = std::min(block, count - first);
    transfer.compute(first, size, std::span(values).subspan(first * dimension, size * dimension));
  }
  return values;
}

class MatrixResume : public testing::TestWithParam<int> {
 protected:
  const TemporaryFolder folder_;
  const fs::path path_ = folder_ / "out.partial";
  const mesh::Scene scene_ = coloured_box(6);
  MatrixOptions options_{.brdf = "phong:3",
                         .band_count = 2,
                         .row_count = 4,
                         .ray_count = 64,
                         .bounce_count = GetParam(),
                         .scratch_folder = folder_.path()};
};

TEST_P(MatrixResume, ContinuesFromAnyPoint) {
  DiffuseStats whole;
  const std::vector<float> expected = matrices(scene_, options_, whole);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  options_.checkpoint = {path_, 0.0};
  DiffuseStats first;
  EXPECT_EQ(matrices(scene_, options_, first), expected);
  const std::string kept = read_text_file(path_);
  DiffuseStats last;
  for (std::size_t step = 0; step <= 6; ++step) {
    folder_.write("out.partial", kept.substr(0, kept.size() * step / 6));
    DiffuseStats stats;
    EXPECT_EQ(matrices(scene_, options_, stats), expected);
    EXPECT_GE(stats.resumed_vertex_count, last.resumed_vertex_count);
    EXPECT_GE(stats.resumed_bounce_share, last.resumed_bounce_share);
    EXPECT_LE(fs::file_size(path_), kept.size() * 3 / 2);
    last = stats;
  }
  EXPECT_EQ(last.resumed_vertex_count, scene_.vertex_count());
  EXPECT_LT(last.rays_cast, whole.rays_cast / 10);
  EXPECT_NEAR(last.resumed_bounce_share, GetParam() > 0 ? 1.0 : 0.0, 1e-9);
}

TEST_P(MatrixResume, AnInterruptedRunIsContinuedAtTheBlockWhereItStopped) {
  DiffuseStats whole, stats;
  const std::vector<float> expected = matrices(scene_, options_, whole);
  options_.checkpoint = {path_, 0.0};
  matrices(scene_, options_, stats, 2);
  EXPECT_EQ(matrices(scene_, options_, stats), expected);
  const int parts = GetParam() + 1;
  EXPECT_NEAR(stats.resumed_bounce_share, GetParam() > 0 ? 1.0 - 1.0 / 3 / parts : 0.0, 0.01);
}

TEST_P(MatrixResume, OtherOptionsStartAnew) {
  options_.checkpoint = {path_, 0.0};
  DiffuseStats stats;
  matrices(scene_, options_, stats);
  const auto is_resumed = [&](const auto& change) {
    MatrixOptions options = options_;
    change(options);
    options.checkpoint.after_seconds = 1e9;  // what is there stays
    matrices(scene_, options, stats);
    return stats.resumed_vertex_count > 0 || stats.resumed_bounce_share > 0;
  };
  EXPECT_TRUE(is_resumed([](MatrixOptions&) {}));
  EXPECT_FALSE(is_resumed([](MatrixOptions& o) { o.brdf = "phong:4"; }));
  EXPECT_FALSE(is_resumed([](MatrixOptions& o) { o.row_count = 3; }));
  EXPECT_FALSE(is_resumed([](MatrixOptions& o) { ++o.bounce_count; }));
  EXPECT_FALSE(is_resumed([](MatrixOptions& o) { o.channels = ChannelMode::one; }));
  EXPECT_FALSE(is_resumed([](MatrixOptions& o) { o.seed = 2; }));
}

INSTANTIATE_TEST_SUITE_P(Bounces, MatrixResume, testing::Values(0, 1, 3));

}  // namespace
}  // namespace prt::transfer
