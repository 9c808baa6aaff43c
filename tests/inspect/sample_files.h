// A small model of two squares, a transfer for it and a compressed one, as files.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "gltf/document.h"
#include "signal/transfer_signal.h"

namespace prt::inspect {

class SampleFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("prt_inspect_") + test->test_suite_name() + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path& folder() const { return folder_; }

  static mesh::Scene scene() {
    mesh::Scene scene;
    scene.materials.emplace_back();
    for (int i = 0; i < 2; ++i) {
      const float x = 2.0f * static_cast<float>(i);
      mesh::Primitive primitive;
      primitive.name = i ? "right" : "left";
      primitive.material = 0;
      primitive.mesh_index = i;
      primitive.mesh.positions = {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}};
      primitive.mesh.normals.assign(4, Vec3(0.0f, 0.0f, 1.0f));
      primitive.mesh.indices = {0, 1, 2, 0, 2, 3};
      scene.primitives.push_back(primitive);
    }
    return scene;
  }

  // Two bands, one channel; vertex v has (1 + v, 2, 0, 0).
  signal::TransferSignal signal() const {
    signal::TransferSignal signal;
    signal.band_count = 2;
    signal.ray_count = 16;
    signal.tool_version = "test";
    signal.mesh_hash = mesh::mesh_hash(stored_scene());
    signal.blocks = {{"left", 4}, {"right", 4}};
    for (int v = 0; v < 8; ++v) {
      signal.values.insert(signal.values.end(), {1.0f + static_cast<float>(v), 2.0f, 0.0f, 0.0f});
    }
    return signal;
  }

  // Five vertices around (2, 2, 0, 0) and three around (6, 2, 0, 0), along the first axis: exact,
  // but for the last vertex, which is off by 0.5.
  gltf::PrecomputedTransfer transfer() const {
    gltf::PrecomputedTransfer transfer;
    transfer.band_count = 2;
    transfer.mesh_hash = mesh::mesh_hash(stored_scene());
    cpca::Encoding& encoding = transfer.encoding;
    encoding.point_count = 8;
    encoding.dimension = 4;
    encoding.cluster_count = 2;
    encoding.component_count = 1;
    encoding.means = {2, 2, 0, 0, 6, 2, 0, 0};
    encoding.bases = {1, 0, 0, 0, 1, 0, 0, 0};
    encoding.cluster_of_point = {0, 0, 0, 0, 0, 1, 1, 1};
    encoding.weights = {-1, 0, 1, 2, 3, 0, 1, 1.5f};
    return transfer;
  }

  std::filesystem::path write_model() const {
    const auto path = folder_ / "model.glb";
    gltf::Document::from_scene(scene()).save_glb(path);
    return path;
  }
  std::filesystem::path write_baked(const gltf::PrecomputedTransfer& transfer) const {
    const auto path = folder_ / "model.prt.glb";
    gltf::Document document = gltf::Document::from_scene(scene());
    document.set_precomputed_transfer(transfer);
    document.save_glb(path);
    return path;
  }
  std::filesystem::path write_transfer() const {
    const auto path = folder_ / "model.transfer.exr";
    signal::write_transfer(path, signal());
    return path;
  }

 private:
  // As it comes back from a file.
  mesh::Scene stored_scene() const { return gltf::Document::load(write_model()).scene(); }

  std::filesystem::path folder_;
};

}  // namespace prt::inspect
