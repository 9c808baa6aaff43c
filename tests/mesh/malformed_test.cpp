// One test for each way in which a mesh file can be wrong, for each format.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "error_of.h"
#include "image/image.h"
#include "mesh/mesh_file.h"
#include "mesh/prepare.h"
#include "temporary_folder.h"

namespace prt::mesh {
namespace {

std::string obj_error(const std::string& text) {
  return error_of([&] { read_obj(text, "a.obj", {}); });
}
std::string ply_error(const std::string& text) {
  return error_of([&] { read_ply(text, "a.ply"); });
}
std::string off_error(const std::string& text) {
  return error_of([&] { read_off(text, "a.off"); });
}
std::string stl_error(const std::string& text) {
  return error_of([&] { read_stl(text, "a.stl"); });
}

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kPlyBody = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST(ObjRead, RejectsIndicesThatDoNotExist) {
  EXPECT_HAS(obj_error(kVertices + "f 1 2 4\n"), "line 4: vertex index past the end");
  EXPECT_HAS(obj_error(kVertices + "f\t1\t2\t-4\n"), "line 4: index out of range");
  EXPECT_HAS(obj_error(kVertices + "f 1 2 0\n"), "line 4: bad index");
  EXPECT_HAS(obj_error(kVertices + "f 1/1 2/1 3/1\n"), "texture coordinate index past the end");
  EXPECT_HAS(obj_error(kVertices + "vn 0 0 1\nf 1//1 2//2 3//1\n"), "normal index past the end");
  EXPECT_HAS(obj_error(kVertices + "f 1 2 99999999999999999999\n"), "bad index");
  EXPECT_HAS(obj_error(kVertices + "f 1 2 4294967297\n"), "index out of range");
}

TEST(ObjRead, RejectsWhatIsNoNumber) {
  EXPECT_HAS(obj_error("v 0 zero 0\n"), "line 1: bad vertex: found \"zero\"");
  EXPECT_HAS(obj_error("v 0 0\n"), "line 1: bad vertex");
  EXPECT_HAS(obj_error(kVertices + "f 1 2\n"), "line 4: bad face");
  EXPECT_HAS(obj_error(kVertices + "f 1 2 3/1/1/1\n"), "bad face corner");
}

TEST(ObjRead, RejectsBinary) {
  EXPECT_HAS(obj_error(std::string("glTF\0\0\0\0", 8)), "not an OBJ file");
}

TEST(ObjRead, RejectsMaterialsOutsideTheFolder) {
  for (const char* name : {"../a.mtl", "/etc/passwd", "http://a/b.mtl", "C:\\a.mtl", "..\\a.mtl"}) {
    EXPECT_HAS(obj_error(std::string("mtllib ") + name + "\n"), "inside the file's own folder");
  }
}

TEST(ObjRead, TexturesShareALimitOfPixels) {
  const TemporaryFolder folder;
  image::write_image(folder / "a.png", image::Image(8, 8, 3));
  image::write_image(folder / "b.png", image::Image(8, 8, 3));
  std::ofstream(folder / "a.mtl") << "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n"
                                     "newmtl c\nmap_Kd a.png\n";
  const std::string text = "mtllib a.mtl\n" + kVertices + "f 1 2 3\n";
  const auto image_count = [&](std::size_t max_pixels) {
    return read_obj(text, folder / "a.obj", {.max_image_pixels = max_pixels}).images.size();
  };
  EXPECT_EQ(image_count(128), 2u);  // and the one used twice is there once
  EXPECT_EQ(image_count(127), 1u);
}

TEST(ObjRead, RejectsLinksToMaterialsOutsideTheFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "inside");
  std::ofstream(folder / "secret.mtl") << "newmtl a\nKd 1 0 0\n";
  std::filesystem::create_symlink(folder / "secret.mtl", folder / "inside" / "far.mtl");
  const std::string text = "mtllib far.mtl\n" + kVertices + "f 1 2 3\n";
  EXPECT_HAS(error_of([&] { read_obj(text, folder / "inside" / "a.obj", {}); }),
             "link out of the folder");
}

TEST(ObjRead, VertexThatIsNotFiniteIsDroppedAndCounted) {
  for (const char* bad : {"nan", "inf", "-inf", "1e999"}) {
    Scene scene = read_obj(kVertices + "v " + bad + " 0 0\nf 1 2 3\nf 1 2 4\n", "a.obj", {});
    const auto reports = prepare(scene, {}, "a.obj");
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_EQ(reports[0].nonfinite_vertex_count, 1u);
    EXPECT_EQ(reports[0].nonfinite_triangle_count, 1u);
    EXPECT_EQ(scene.triangle_count(), 1u);
  }
}

TEST(MeshRead, RejectsMissingUnknownAndEmptyFiles) {
  EXPECT_HAS(error_of([] { read_mesh_file("no/such.obj"); }), "no such file");
  EXPECT_HAS(error_of([] { read_mesh_file("a.dwg"); }), "unknown kind of mesh file");
  Scene scene = read_obj(kVertices + "f 1 1 2\n", "a.obj", {});
  EXPECT_HAS(error_of([&] { prepare(scene, {}, "a.obj"); }), "a.obj: empty mesh");
}

TEST(PlyRead, RejectsWrongMagic) { EXPECT_HAS(ply_error("PLY\n"), "not a PLY file"); }

TEST(PlyRead, RejectsCountsThatTheFileHasNoRoomFor) {
  const std::string huge = replaced(kPly, "vertex 3", "vertex 4000000000");
  EXPECT_HAS(ply_error(huge + kPlyBody), "the file is too small for its header");
  EXPECT_HAS(ply_error(replaced(huge, "ascii", "binary_little_endian")), "too small");
  EXPECT_HAS(ply_error(replaced(kPly, "face 1", "face 4000000000") + kPlyBody), "too small");
  EXPECT_HAS(ply_error(replaced(kPly, "vertex 3", "vertex 99999999999999999999")),
             "bad element count");
  EXPECT_HAS(ply_error(replaced(kPly, "vertex 3", "vertex -1")), "bad element count");
  EXPECT_HAS(ply_error(kPly + "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"), "list entries");
}

TEST(PlyRead, RejectsTruncation) {
  EXPECT_EQ(ply_error(kPly + kPlyBody), "no error");
  const std::string whole = kPly + kPlyBody;
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    EXPECT_NE(ply_error(whole.substr(0, size)), "no error") << size;
  }
}

TEST(PlyRead, RejectsBadIndicesAndHeaders) {
  EXPECT_HAS(ply_error(kPly + replaced(kPlyBody, "3 0 1 2", "3 0 1 3")), "past the end");
  EXPECT_HAS(ply_error(kPly + replaced(kPlyBody, "3 0 1 2", "3 0 -1 2")), "bad vertex index");
  EXPECT_HAS(ply_error(replaced(kPly, "float z", "half z") + kPlyBody), "unknown property type");
  EXPECT_HAS(ply_error(replaced(kPly, "float z", "float w") + kPlyBody), "without x, y, z");
  EXPECT_HAS(ply_error(replaced(kPly, "ascii", "base64") + kPlyBody), "unknown PLY format");
}

TEST(PlyRead, RejectsASecondElementOfVertices) {
  EXPECT_HAS(ply_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                       "property float y\nproperty float z\nproperty float nx\n"
                       "property float ny\nproperty float nz\nelement vertex 2\n"
                       "property float x\nproperty float y\nproperty float z\nelement face 1\n"
                       "property list uchar int vertex_indices\nend_header\n"
                       "0 0 0 0 0 1\n1 0 0\n0 1 0\n3 0 1 2\n"),
             "a second element vertex");
}

TEST(OffRead, RejectsWhatIsWrong) {
  const std::string whole = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(off_error(whole), "no error");
  EXPECT_HAS(off_error("FOO\n"), "not an OFF file");
  EXPECT_HAS(off_error(replaced(whole, "3 1 0", "4000000000 1 0")), "bad count");
  EXPECT_HAS(off_error(replaced(whole, "3 0 1 2", "3 0 1 3")), "past the end");
  EXPECT_HAS(off_error(replaced(whole, "3 0 1 2", "3 0 1")), "truncated");
}

TEST(StlRead, RejectsWhatIsWrong) {
  std::string binary(84, ' ');
  binary[80] = binary[81] = binary[82] = binary[83] = '\xff';
  EXPECT_HAS(stl_error(binary), "not an STL file, or truncated");
  EXPECT_HAS(stl_error("soli"), "not an STL file, or truncated");
  EXPECT_HAS(stl_error("solid a\nfacet\nouter loop\nvertex 0 0 0\n"), "truncated");
  EXPECT_HAS(stl_error("solid a\nvertex 0 0 0\nvertex 0 0 0\nendloop\nendsolid\n"), "no triangle");
}

}  // namespace
}  // namespace prt::mesh
