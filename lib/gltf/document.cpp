#include "gltf/document.h"

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "gltf/check.h"
#include "gltf/container.h"
#include "gltf/image_types.h"
#include "gltf/state.h"
#include "mesh/mesh_file.h"

namespace prt::gltf {

Document::Document(std::unique_ptr<State> state) : state_(std::move(state)) {}
Document::Document(Document&&) noexcept = default;
Document& Document::operator=(Document&&) noexcept = default;
Document::~Document() = default;

Document Document::load(const std::filesystem::path& path, const Limits& limits) {
  const auto bytes = read_file(path, limits.max_file_bytes);
  if (mesh::is_mesh_file(path)) {
    throw_bad_input("not a glTF file",
                    {.file = path.string(), .advice = "Pass the file through prt-import first."});
  }
  return parse(bytes, path, limits);
}

Document Document::parse(std::span<const std::byte> bytes, const std::filesystem::path& path,
                         const Limits& limits) {
  auto state = std::make_unique<State>();
  state->file = path.string();
  state->limits = limits;
  load_container(*state, bytes);
  check_document(*state);
  name_image_types(*state);
  return Document(std::move(state));
}

void Document::save_glb(const std::filesystem::path& path, bool no_clobber) const {
  AtomicFile file(path, no_clobber);
  file.write(make_glb(*state_));
  file.commit();
}

std::vector<std::byte> Document::glb_bytes() const { return make_glb(*state_); }

}  // namespace prt::gltf
