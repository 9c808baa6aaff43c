// Buffers and images beside a .gltf: only those in its folder are read.
#include <gtest/gtest.h>

#include "gltf/container.h"
#include "gltf/malformed.h"
#include "temporary_folder.h"

namespace prt::gltf {
namespace {

using samples::parse;

TEST(GltfRead, RejectsUrisThatLeaveTheFolder) {
  for (const char* uri : {"../secret.bin", "a/../../secret.bin", "/etc/passwd", "%2e%2e/secret.bin",
                          "%2E%2E%2Fsecret.bin", "..\\secret.bin", "file:///etc/passwd",
                          "https://example.com/a.bin", "C:\\a.bin", "", "%2fetc/passwd"}) {
    EXPECT_ERROR(with("/buffers/0/uri", uri), "a relative path inside the file's own folder")
        << uri;
  }
  EXPECT_ERROR(with("/images", {{{"uri", "../a.png"}}}), "a relative path inside");
}

TEST(GltfRead, RejectsLinksThatLeaveTheFolder) {
  const TemporaryFolder inside, outside;
  outside.write("secret.bin", std::string(42, 'x'));
  inside.write("near.bin", std::string(42, 'x'));
  std::filesystem::create_symlink(outside / "secret.bin", inside / "far.bin");
  std::filesystem::create_directory_symlink(outside / ".", inside / "folder");
  std::filesystem::create_symlink("near.bin", inside / "alias.bin");
  const auto error_with = [&](const char* uri) {
    const std::string text = with("/buffers/0/uri", uri).dump();
    return error_of([&] { Document::parse(bytes_of(text), inside / "a.gltf"); });
  };
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "link out of the folder", error_with("far.bin"));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "link out of the folder",
                      error_with("folder/secret.bin"));
  EXPECT_EQ(error_with("alias.bin"), "no error");
}

TEST(GltfRead, RejectsBadDataUris) {
  EXPECT_ERROR(with("/buffers/0/uri", "data:application/octet-stream;base64,A*A="), "bad base64");
  EXPECT_ERROR(with("/buffers/0/uri", "data:text/plain,abc"), "not base64");
  EXPECT_ERROR(with("/buffers/0/uri", "data:application/octet-stream;base64,AAAA"), "truncated");
}

TEST(GltfRead, ReadsFilesBesideItAndEmbedsThem) {
  const TemporaryFolder folder;
  const std::string uri = samples::triangle_json()["buffers"][0]["uri"];
  const Bytes bytes = decode_data_uri(uri, {"a.gltf", "buffer 0"});
  folder.write("tri angle.bin", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const auto path = folder.write("a.gltf", with("/buffers/0/uri", "tri%20angle.bin").dump());
  EXPECT_EQ(Document::load(path).glb_bytes(), parse(samples::triangle_json()).glb_bytes());
}

}  // namespace
}  // namespace prt::gltf
