// A glTF 2.0 file in memory. Everything prtkit does not know (extensions, extras, cameras,
// animations, …) survives loading and saving.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gltf/precomputed_transfer.h"
#include "mesh/scene.h"

namespace prt::gltf {

/// What a hostile file may not exceed.
struct Limits {
  std::size_t max_file_bytes = std::size_t{4} << 30;
  std::size_t max_image_pixels = image::kMaxPixels;  ///< of the images that are decoded, in all
  std::size_t max_node_depth = 256;
  std::size_t max_primitive_count = 1 << 16;  ///< counted once for each node that shows it
  std::size_t max_element_count = std::size_t{1} << 30;  ///< attribute values and indices, in all
};

class Document {
 public:
  /// Reads .glb or .gltf; buffers and images are loaded from data URIs and from files beside it (no
  /// absolute path, no "..", no scheme). Throws Error (bad_input).
  static Document load(const std::filesystem::path& path, const Limits& limits = {});
  /// The same of bytes in memory; `path` is for messages and for the files it refers to.
  static Document parse(std::span<const std::byte> bytes, const std::filesystem::path& path,
                        const Limits& limits = {});

  /// A new document with one node and mesh for each primitive of the scene. Of its material, the
  /// texture stays only if it has texture coordinates. Images that nothing shows are left out.
  static Document from_scene(const mesh::Scene& scene);

  Document(Document&&) noexcept;
  Document& operator=(Document&&) noexcept;
  ~Document();

  /// All mesh primitives of the default scene in world space, images decoded. A mesh used by two
  /// nodes, or a primitive that is no indexed triangle list with normals, is an Error that advises
  /// prt-import.
  mesh::Scene scene() const;

  /// What a bake leaves out of that: skins (meshes are in bind pose), morph targets, animations,
  /// features of materials that it does not know and, unless it is glossy, metals. A line for
  /// people each, with names; empty: nothing is missing. `scene` is what scene() gave.
  std::vector<std::string> unbaked_features(const mesh::Scene& scene, bool is_glossy) const;

  /// PRTKIT_precomputed_transfer, if the file has it. Checks every accessor and range.
  std::optional<PrecomputedTransfer> precomputed_transfer() const;
  /// Adds or replaces it.
  void set_precomputed_transfer(const PrecomputedTransfer& transfer);
  void remove_precomputed_transfer();

  /// Writes .glb, everything embedded, atomically.
  void save_glb(const std::filesystem::path& path, bool no_clobber = false) const;
  /// What save_glb writes: the same document gives the same bytes.
  std::vector<std::byte> glb_bytes() const;

  struct State;  ///< private to lib/gltf, as is its use
  State* state() { return state_.get(); }

 private:
  explicit Document(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prt::gltf
