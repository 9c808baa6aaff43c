// Images: where they are, what they are, how many pixels all may have.
#include <gtest/gtest.h>

#include <cstring>

#include "gltf/document.h"
#include "gltf/malformed.h"

namespace prt::gltf {
namespace {

using samples::parse;

TEST(GltfImages, RejectsImageViewThatDoesNotExistOrRunsPastItsBuffer) {
  EXPECT_ERROR(with("/images", {{{"bufferView", 2}, {"mimeType", "image/png"}}}), "image 0");
  ordered_json json = with("/images", {{{"bufferView", 2}, {"mimeType", "image/png"}}});
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 40}, {"byteLength", 100}});
  EXPECT_ERROR(json, "bufferView 2: runs past the end of its buffer");
}

TEST(GltfImages, RejectsImagesOfTypesThatTheFileDoesNotName) {
  // "RIFF....WEBP", "RIFF....WAVE"
  const std::string webp = "data:application/octet-stream;base64,UklGRgAAAABXRUJQ";
  const std::string wave = "data:application/octet-stream;base64,UklGRgAAAABXQVZF";
  EXPECT_ERROR(with("/images", {{{"uri", webp}}}), "image 0: not an image that glTF knows");
  ordered_json json = with("/images", {{{"uri", wave}}});
  json["extensionsUsed"] = {"EXT_texture_webp"};
  EXPECT_ERROR(json, "image 0: not an image that glTF knows");
  json = with("/images", {{{"uri", webp}}});
  json["extensionsUsed"] = {"EXT_texture_webp"};
  EXPECT_NO_THROW(parse(json));
  // "....ftypavif"
  json = with("/images", {{{"uri", "data:;base64,AAAAAGZ0eXBhdmlm"}}});
  EXPECT_ERROR(json, "image 0: not an image that glTF knows");
  json["extensionsUsed"] = {"EXT_texture_avif"};
  EXPECT_NO_THROW(parse(json));
}

TEST(GltfImages, TypesInViewsAreThoseOfTheirBytes) {
  ordered_json json = with("/images", {{{"bufferView", 2}, {"mimeType", "image/jpeg"}}});
  json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 8}});
  json["buffers"].push_back({{"byteLength", 8}, {"uri", "data:image/png;base64,iVBORw0KGgo="}});
  const auto glb = parse(json).glb_bytes();
  const std::string text(reinterpret_cast<const char*>(glb.data()), glb.size());
  EXPECT_NE(text.find("\"mimeType\":\"image/png\""), std::string::npos);
  json["bufferViews"][2]["byteOffset"] = 1;
  json["bufferViews"][2]["byteLength"] = 7;
  EXPECT_ERROR(json, "image 0: not an image that glTF knows");
}

TEST(GltfImages, ShareALimitOfPixelsAndAreDecodedOnce) {
  mesh::Scene scene = samples::scene();  // a texture of 2 x 2 pixels
  scene.images.push_back(scene.images[0]);
  scene.materials[1].base_color_image = 1;
  auto bytes = Document::from_scene(scene).glb_bytes();
  const auto load = [&](std::size_t max_pixels) {
    return Document::parse(bytes, "a.glb", {.max_image_pixels = max_pixels}).scene().images.size();
  };
  EXPECT_EQ(load(8), 2u);
  EXPECT_ERROR([&] { load(7); }, "found 2 x 2 pixels, expected 1 to 3 pixels");
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t first = text.find("\"bufferView\"", text.find("\"images\""));
  const std::size_t second = text.find("\"bufferView\"", first + 1);
  std::copy_n(&bytes[first], std::strlen("\"bufferView\":12"), &bytes[second]);
  EXPECT_EQ(load(4), 1u);
}

}  // namespace
}  // namespace prt::gltf
