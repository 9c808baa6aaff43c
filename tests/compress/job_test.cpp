// The whole of prt-compress, and what its files hold when they are read again.
#include "compress/job.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "compress/encode.h"
#include "compress/signal.h"
#include "core/error.h"
#include "core/file.h"
#include "cpca/meshes.h"
#include "gltf/document.h"
#include "signal/transfer_signal.h"
#include "temporary_folder.h"

namespace prt::compress {
namespace {

constexpr std::uint32_t kSide = 48;
constexpr std::size_t kDimension = 16;

class CompressedModel : public testing::Test {
 protected:
  CompressedModel() {
    mesh::Scene scene;
    scene.materials.emplace_back();
    mesh::Primitive primitive;
    primitive.material = 0;
    primitive.mesh.indices = cpca::grid(kSide, kSide);
    for (std::uint32_t p = 0; p < kSide * kSide; ++p) {
      const auto x = static_cast<float>(p % kSide), y = static_cast<float>(p / kSide);
      primitive.mesh.positions.emplace_back(x * x, y, 0.0f);  // areas differ
      primitive.mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
      for (std::size_t i = 0; i < kDimension; ++i) {
        const auto k = static_cast<float>(i);
        signal_.values.push_back(std::sin(0.02f * (k + 1) * x + 0.1f * y) +
                                 std::cos(0.03f * k * y) + (x * x > 30 * y ? 0.4f : 0.0f));
      }
    }
    scene.primitives.push_back(primitive);
    gltf::Document::from_scene(scene).save_glb(folder_ / "a.glb");
    scene_ = gltf::Document::load(folder_ / "a.glb").scene();
    signal_.band_count = 4;
    signal_.tool_version = "test";
    signal_.mesh_hash = mesh::mesh_hash(scene_);
    signal_.blocks = {{scene_.primitives[0].name, kSide * kSide}};
    signal::write_transfer(folder_ / "a.transfer.exr", signal_);
    job_.model = folder_ / "a.glb";
    job_.transfer = folder_ / "a.transfer.exr";
    job_.output = folder_ / "a.prt.glb";
    job_.iterations = 8;
  }

  /// Errors of what the file holds.
  Errors stored(const Weights& weights) {
    const auto transfer = gltf::Document::load(job_.output).precomputed_transfer();
    return measure(transfer->encoding, signal_.values, weights);
  }

  /// Of a job that has to fail.
  Error failure() {
    Report report("test");
    try {
      run(job_, report);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::failed);
      return error;
    }
    ADD_FAILURE() << "no error";
    return Error(ErrorKind::failed, "no error");
  }

  TemporaryFolder folder_;
  mesh::Scene scene_;
  signal::TransferSignal signal_;
  Job job_;
};

TEST_F(CompressedModel, KeepsToTheBoundAsWritten) {
  job_.storage.coherence.error_budget = 0.5;  // much to spend on moves
  int moved_count = 0;
  for (const cpca::Norm norm : {cpca::Norm::rmse, cpca::Norm::maximum}) {
    for (const double max_error : {0.05, 0.02, 0.003}) {
      job_.bound.max_error = max_error;
      job_.bound.norm = norm;
      Report report("test");
      run(job_, report);
      const Errors errors = stored({});
      const bool is_rmse = norm == cpca::Norm::rmse;
      const double found = is_rmse ? errors.relative_rmse() : errors.relative_max();
      EXPECT_LE(found, max_error);
      EXPECT_GT(found, 0.2 * max_error);
      moved_count += report.json()["moved_count"].get<int>();
      EXPECT_NEAR(report.json()[is_rmse ? "relative_rmse" : "relative_max"].get<double>(), found,
                  1e-9 + 1e-5 * found);
    }
  }
  EXPECT_GT(moved_count, 0);
}

TEST_F(CompressedModel, HasAVertexInEveryCluster) {
  signal::TransferSignal twice = signal_;  // two different rows: a cluster each
  for (std::size_t i = 0; i < twice.values.size(); ++i)
    twice.values[i] = i < twice.values.size() / 2 ? 1.0f : 2.0f;
  job_.cluster_count = 600;
  job_.component_count = 1;
  job_.storage.coherence.error_budget = 100.0;  // many moves
  for (const bool is_incoherent : {false, true}) {
    for (const signal::TransferSignal* signal : {&signal_, &twice}) {
      signal::write_transfer(job_.transfer, *signal);
      job_.storage.is_incoherent = is_incoherent;
      Report report("test");
      run(job_, report);
      const cpca::Encoding encoding =
          gltf::Document::load(job_.output).precomputed_transfer()->encoding;
      const auto& labels = encoding.cluster_of_point;
      const std::set<std::uint32_t> used(labels.begin(), labels.end());
      EXPECT_EQ(encoding.cluster_count, static_cast<int>(used.size()));
      EXPECT_EQ(report.json()["cluster_count"], encoding.cluster_count);
      if (signal == &twice) {
        EXPECT_EQ(encoding.cluster_count, 2);
      } else if (!is_incoherent) {
        EXPECT_LT(encoding.cluster_count, 600);
      }
    }
  }
}

TEST_F(CompressedModel, TellsWhetherCoherenceIsLeftOut) {
  job_.cluster_count = 12;
  job_.component_count = 3;
  job_.storage.weights = cpca::WeightFormat::unorm16;
  Report report("test");
  const Input input = load(job_, report);
  const Result encoded = encode(job_, input, report);
  for (const bool is_left_out : {true, false}) {
    job_.bound.max_error = is_left_out ? 1e-6 : 0.5;
    Result result = encoded;
    const cpca::Storage storage = store(job_, input, result, report);
    EXPECT_EQ(report.json()["coherence_left_out"], is_left_out);
    EXPECT_EQ(storage.coherence.has_value(), !is_left_out);
  }
}

TEST_F(CompressedModel, KeepsToTheBoundByItsWeights) {
  const std::vector<float> areas = vertex_areas(scene_);
  job_.weigh_by_area = true;
  for (const cpca::Norm norm : {cpca::Norm::rmse, cpca::Norm::maximum}) {
    job_.bound.max_error = 0.02;
    job_.bound.norm = norm;
    Report report("test");
    run(job_, report);
    const Errors errors = stored({.points = areas});
    EXPECT_LE(norm == cpca::Norm::rmse ? errors.relative_rmse() : errors.relative_max(), 0.02);
    EXPECT_NEAR(report.json()["weighted_relative_rmse"].get<double>(), errors.relative_rmse(),
                1e-5 * errors.relative_rmse());
    EXPECT_NEAR(report.json()["relative_rmse"].get<double>(), stored({}).relative_rmse(),
                1e-5 * errors.relative_rmse());
  }
}

TEST_F(CompressedModel, OfMatricesKeepsToTheBoundAsExitRadiance) {
  signal_.row_count = 4;
  signal_.band_count = 2;
  signal::write_transfer(folder_ / "a.transfer.exr", signal_);
  job_.bound.max_error = 0.02;
  Report report("test");
  run(job_, report);
  const sh::RadianceMetric metric(4, 4);
  const double found = stored({.metric = &metric}).relative_rmse();
  EXPECT_LE(found, 0.02);
  EXPECT_NEAR(report.json()["weighted_relative_rmse"].get<double>(), found, 1e-5 * found);
  EXPECT_NEAR(report.json()["relative_rmse"].get<double>(), stored({}).relative_rmse(), 1e-7);
  EXPECT_GT(stored({}).relative_rmse(), 1.2 * found);  // coefficients tell something else
}

TEST_F(CompressedModel, AutoIsNoWorseWithinABoundThanAnyFormat) {
  // Searches of about three encodings each end that far apart by chance, one adaptive one 7%.
  constexpr double kLuck = 1.03, kAdaptiveLuck = 1.08;
  constexpr double kNone = 1e-4;  // errors below need not be less
  const auto result = [&](std::optional<cpca::WeightFormat> weights) {
    job_.storage.weights = weights;
    Report report("test");
    run(job_, report);
    const Errors errors = stored({});
    const double error =
        job_.bound.norm == cpca::Norm::rmse ? errors.relative_rmse() : errors.relative_max();
    if (job_.bound.max_error) {
      EXPECT_LE(error, *job_.bound.max_error);
    } else {
      EXPECT_LE(report.json()["bytes"].get<std::size_t>(), *job_.bound.max_bytes);
    }
    return job_.bound.max_error ? report.json()["bytes"].get<double>() : error;
  };
  const auto compare = [&] {
    const double chosen = result({}), luck = job_.method == "adaptive" ? kAdaptiveLuck : kLuck;
    for (const auto format : {cpca::WeightFormat::float32, cpca::WeightFormat::float16,
                              cpca::WeightFormat::unorm16, cpca::WeightFormat::unorm8}) {
      try {
        EXPECT_LE(chosen, std::max(kNone, luck * result(format))) << cpca::name_of(format);
      } catch (const Error& error) {  // too coarse
        EXPECT_TRUE(job_.bound.max_error && format == cpca::WeightFormat::unorm8) << error.what();
      }
    }
  };
  for (const char* method : {"static", "iterative", "adaptive"}) {
    job_.method = method;
    for (const cpca::Norm norm : {cpca::Norm::rmse, cpca::Norm::maximum}) {
      for (const double max_error : {0.01, 0.002}) {
        SCOPED_TRACE(std::string(method) + " within " + std::to_string(max_error));
        job_.bound = {.max_error = max_error, .norm = norm, .max_bytes = {}};
        compare();
      }
    }
    for (const std::size_t max_bytes : {20000u, 60000u}) {
      SCOPED_TRACE(std::string(method) + " in " + std::to_string(max_bytes));
      job_.bound = {.max_error = {}, .max_bytes = max_bytes};
      compare();
    }
  }
}

TEST_F(CompressedModel, FailsWhenTheGivenWeightsAreTooCoarse) {
  job_.bound.max_error = 0.0005;
  job_.storage.weights = cpca::WeightFormat::unorm8;
  EXPECT_EQ(failure().details().advice, "Take --weights auto.");
  EXPECT_FALSE(std::filesystem::exists(job_.output));
  job_.storage.weights.reset();
  Report report("test");
  run(job_, report);
  EXPECT_LE(stored({}).relative_rmse(), 0.0005);
}

TEST_F(CompressedModel, NamesTheBoundOfTheUserWhenNothingIsWithin) {
  job_.method = "vq";
  job_.bound.max_error = 1e-7;
  const Error error = failure();
  EXPECT_EQ(error.details().expected, "at most 1e-07 as stored, 9.759e-08 as encoded");
  EXPECT_TRUE(error.details().found.starts_with("a relative error of ")) << error.what();
}

// The room for rounding takes integers beyond what one vector a cluster reaches.
TEST_F(CompressedModel, AutoGoesOnWhereOneFormatFindsNothing) {
  job_.method = "adaptive";
  job_.max_component_count = 1;
  job_.bound.max_error = 0.01307;
  job_.iterations = 1;
  Report report("test");
  run(job_, report);
  EXPECT_EQ(report.json()["weights"], "float");
  EXPECT_LE(stored({}).relative_rmse(), 0.01307);
}

TEST_F(CompressedModel, IsTheSameOfASignalOfAnySize) {
  job_.cluster_count = 12;
  job_.component_count = 3;
  Report report("test");
  run(job_, report);
  const double expected = stored({}).relative_rmse();
  for (const float size : {1e-30f, 1e30f}) {
    for (float& value : signal_.values) value *= size;
    signal::write_transfer(folder_ / "a.transfer.exr", signal_);
    run(job_, report);
    EXPECT_NEAR(stored({}).relative_rmse(), expected, 0.02 * expected);
    for (float& value : signal_.values) value /= size;
  }
}

TEST_F(CompressedModel, AnInterruptedRunIsContinuedByOneOfTheSameSignalAndOptions) {
  job_.cluster_count = 12;
  job_.component_count = 3;
  job_.checkpoint = {folder_ / "a.prt.glb.partial", 0.0};
  Report whole("test");
  run(job_, whole);
  const std::string expected = read_text_file(job_.output);
  EXPECT_FALSE(std::filesystem::exists(job_.checkpoint.path));
  // Stopped where the file would be written.
  job_.no_clobber = true;
  Report stopped("test");
  EXPECT_THROW(run(job_, stopped), Error);
  const std::string kept = read_text_file(job_.checkpoint.path);
  job_.no_clobber = false;

  const auto resumed_iterations = [&](const auto& change) {
    folder_.write("a.prt.glb.partial", kept);
    Job job = job_;
    change(job);
    Report report("test");
    run(job, report);
    EXPECT_FALSE(std::filesystem::exists(job_.checkpoint.path));
    return report.json()["resumed_iteration_count"].get<int>();
  };
  EXPECT_EQ(resumed_iterations([](Job&) {}), whole.json()["iteration_count"].get<int>());
  EXPECT_EQ(read_text_file(job_.output), expected);
  EXPECT_GT(resumed_iterations([](Job& job) { job.storage.is_incoherent = true; }), 0);
  EXPECT_EQ(resumed_iterations([](Job& job) { job.cluster_count = 13; }), 0);
  EXPECT_EQ(resumed_iterations([](Job& job) { job.component_count = 4; }), 0);
  EXPECT_EQ(resumed_iterations([](Job& job) { job.iterations = 9; }), 0);
  EXPECT_EQ(resumed_iterations([](Job& job) { job.seed = 2; }), 0);
  EXPECT_EQ(resumed_iterations([](Job& job) { job.weigh_by_area = true; }), 0);
  signal_.values[5] += 1.0f;
  signal::write_transfer(folder_ / "a.transfer.exr", signal_);
  EXPECT_EQ(resumed_iterations([](Job&) {}), 0);
}

}  // namespace
}  // namespace prt::compress
