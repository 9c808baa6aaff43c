#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh/mesh_file.h"
#include "mesh/prepare.h"

namespace prt::mesh {
namespace {

TEST(ObjRead, PolygonsNegativeIndicesAndTabs) {
  const Scene scene = read_obj(
      "v 0 0 0\nv 1 0 0\nv\t1 1 0\nv 0 1 0\nvn 0 0 1\n"
      "f\t-4//-1\t-3//-1\t-2//-1\t-1//-1\n",
      "a.obj", {});
  ASSERT_EQ(scene.primitives.size(), 1u);
  const TriangleMesh& mesh = scene.primitives[0].mesh;
  EXPECT_EQ(mesh.vertex_count(), 4u);
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh.normals[2], Vec3(0, 0, 1));
}

TEST(ObjRead, VerticesThatNoFaceUsesAreDroppedAndCounted) {
  Scene scene = read_obj(
      "v 0 0 0\nv 1 0 0\nv 7 7 7\nv 1 1 0\nv 8 8 8\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 4/1/1\n",
      "a.obj", {});
  EXPECT_EQ(prepare(scene, {}, "a.obj")[0].unreferenced_vertex_count, 2u);
  EXPECT_EQ(scene.vertex_count(), 3u);
}

TEST(ObjRead, RejectsIndexPastEnd) {
  try {
    read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a.obj", {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.details().element, "line 4");
    EXPECT_EQ(error.details().found, "\"4\"");
  }
}

}  // namespace
}  // namespace prt::mesh
