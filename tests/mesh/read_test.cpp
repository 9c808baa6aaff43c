#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

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

TEST(ObjRead, TextureCoordinatesCountFromTheTop) {
  const Scene scene = read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.125\nf 1/1 2/1 3/1\n", "", {});
  EXPECT_EQ(scene.primitives[0].mesh.texcoords[0], Vec2(0.25f, 0.875f));
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

// Values of the types and in the byte order of a PLY format.
class PlyBody {
 public:
  explicit PlyBody(const std::string& format) : format_(format) {}

  template <class T>
  void add(const std::vector<T>& values) {
    for (const T value : values) {
      const auto* bytes = reinterpret_cast<const char*>(&value);
      std::string text(bytes, sizeof(value));
      if (format_ == "binary_big_endian") std::reverse(text.begin(), text.end());
      text_ += format_ == "ascii" ? std::to_string(value) + "\n" : text;
    }
  }
  const std::string& text() const { return text_; }

 private:
  std::string format_, text_;
};

TEST(PlyRead, ReadsTheSameFromEveryFormat) {
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    PlyBody body(format);
    for (int i = 0; i < 4; ++i) {
      const float x = static_cast<float>(i);
      body.add<double>({x + 0.5});
      body.add<float>({2.0f * x, -x, 0.0f, 0.6f, 0.8f, 0.25f, 0.125f * x});
      body.add<std::uint16_t>({65535, 13107, 0});
    }
    body.add<std::int16_t>({7});  // of a property that is not read
    body.add<std::uint8_t>({4});
    body.add<std::int32_t>({3, 2, 1, 0});
    const std::string header = "ply\nformat " + format +
                               " 1.0\ncomment a quad\nelement vertex 4\nproperty double x\n"
                               "property float y\nproperty float z\nproperty float nx\n"
                               "property float ny\nproperty float nz\nproperty float s\n"
                               "property float t\nproperty ushort red\nproperty ushort green\n"
                               "property ushort blue\nelement face 1\nproperty short flags\n"
                               "property list uchar int vertex_indices\nend_header\n";
    const TriangleMesh mesh = read_ply(header + body.text(), "a.ply");
    ASSERT_EQ(mesh.vertex_count(), 4u) << format;
    EXPECT_EQ(mesh.positions[3], Vec3(3.5f, 6, -3)) << format;
    EXPECT_EQ(mesh.normals[3], Vec3(0, 0.6f, 0.8f)) << format;
    EXPECT_EQ(mesh.texcoords[3], Vec2(0.25f, 1 - 0.375f)) << format;
    EXPECT_TRUE(mesh.colors[3].equalWithAbsError(Vec4(1, 0.2f, 0, 1), 1e-6f)) << format;
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{3, 2, 1, 3, 1, 0})) << format;
  }
}

TEST(PlyRead, DoublesBeyondFloatAreInfinite) {
  PlyBody body("binary_little_endian");
  body.add<double>({1e300, -1e39, 3.5e38, 3e38, 0.1, 1e-300});
  const TriangleMesh mesh = read_ply(
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\n"
      "property double y\nproperty double z\nend_header\n" +
          body.text(),
      "a.ply");
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(mesh.positions[0], Vec3(infinity, -infinity, infinity));
  EXPECT_EQ(mesh.positions[1], Vec3(3e38f, 0.1f, 0));
}

TEST(PlyRead, ColoursOf8BitsAreSrgb) {
  const TriangleMesh mesh = read_ply(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty float blue\n"
      "end_header\n0 0 0 128 255 0.5\n",
      "a.ply");
  EXPECT_NEAR(mesh.colors[0].x, 0.215861f, 1e-6f);
  EXPECT_EQ(mesh.colors[0].y, 1.0f);
  EXPECT_EQ(mesh.colors[0].z, 0.5f);
}

TEST(OffRead, ReadsWhatEachPrefixAnnounces) {
  const struct {
    const char *prefix, *vertex;
    bool normals, texcoords;
  } cases[] = {{"", "1 2 3", false, false},
               {"C", "1 2 3 255 0 0 255", false, false},
               {"N", "1 2 3 0 0.6 0.8", true, false},
               {"CN", "1 2 3 0 0.6 0.8 0.1 0.2 0.3", true, false},
               {"ST", "1 2 3 0.25 0.125", false, true},
               {"STN", "1 2 3 0 0.6 0.8 0.25 0.125", true, true},
               {"STC", "1 2 3 9 9 9 9 0.25 0.125  # last", false, true}};
  for (const auto& test : cases) {
    const TriangleMesh mesh =
        read_off(std::string(test.prefix) + "OFF\n4 1 0\n" + test.vertex + "\n" + test.vertex +
                     "\n" + test.vertex + "\n" + test.vertex + "\n4 0 1 2 3 255 0 0\n",
                 "a.off");
    ASSERT_EQ(mesh.vertex_count(), 4u) << test.prefix;
    EXPECT_EQ(mesh.positions[3], Vec3(1, 2, 3)) << test.prefix;
    ASSERT_EQ(mesh.normals.size(), test.normals ? 4u : 0u) << test.prefix;
    ASSERT_EQ(mesh.texcoords.size(), test.texcoords ? 4u : 0u) << test.prefix;
    for (const Vec3& normal : mesh.normals) EXPECT_EQ(normal, Vec3(0, 0.6f, 0.8f)) << test.prefix;
    for (const Vec2& t : mesh.texcoords) EXPECT_EQ(t, Vec2(0.25f, 0.875f)) << test.prefix;
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3})) << test.prefix;
  }
}

TEST(StlRead, ReadsTheSameFromTextAndBinary) {
  const float facet[12] = {0, 0, 1, 0, 0, 0.5f, 1, 0, 0.5f, 0, 1, 0.5f};  // the normal first
  std::string binary = "solid, as headers of binary files may begin, too";
  binary.resize(80);
  binary += std::string("\1\0\0\0", 4) +
            std::string(reinterpret_cast<const char*>(facet), sizeof(facet)) + std::string(2, 0);
  const std::string text =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.5\nvertex 1 0 0.5\n"
      "vertex 0 1 0.5\nendloop\nendfacet\nendsolid a\n";
  for (const std::string& file : {text, binary}) {
    const TriangleMesh mesh = read_stl(file, "a.stl");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0.5f}, {1, 0, 0.5f}, {0, 1, 0.5f}}));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  }
}

}  // namespace
}  // namespace prt::mesh
