// Every reader of mesh files on any bytes, and repair of whatever they accept.
#include <string_view>

#include "core/error.h"
#include "core/log.h"
#include "mesh/mesh_file.h"
#include "mesh/prepare.h"

namespace {

const std::filesystem::path kPath = "/nonexistent/fuzz";

void use(prt::mesh::Scene scene) {
  prt::mesh::prepare(scene, {.repair = {.crease_angle_degrees = 30.0f}}, "fuzz");
  for (const prt::mesh::Primitive& primitive : scene.primitives) {
    for (const std::uint32_t index : primitive.mesh.indices) {
      if (index >= primitive.mesh.vertex_count()) __builtin_trap();
    }
  }
}

template <class Read>
void attempt(const Read& read) {
  try {
    use(read());
  } catch (const prt::Error&) {
  }
}

prt::mesh::Scene scene_of(prt::mesh::TriangleMesh mesh) {
  prt::mesh::Scene scene;
  scene.primitives.emplace_back().mesh = std::move(mesh);
  return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  prt::log::set_level(prt::log::Level::error);
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  attempt([&] { return prt::mesh::read_obj(bytes, kPath, {}); });
  attempt([&] { return scene_of(prt::mesh::read_ply(bytes, kPath)); });
  attempt([&] { return scene_of(prt::mesh::read_off(bytes, kPath)); });
  attempt([&] { return scene_of(prt::mesh::read_stl(bytes, kPath)); });
  return 0;
}
