// Reads a model, checks and repairs it, writes .glb: docs/tools/prt-import.md.
#include "cli/paths.h"
#include "cli/tool.h"
#include "core/log.h"
#include "gltf/import.h"

namespace {

using prt::mesh::RepairReport;

constexpr std::pair<const char*, std::size_t RepairReport::*> kRepairKeys[] = {
    {"welded_vertex_count", &RepairReport::welded_vertex_count},
    {"unreferenced_vertex_count", &RepairReport::unreferenced_vertex_count},
    {"nonfinite_vertex_count", &RepairReport::nonfinite_vertex_count},
    {"nonfinite_triangle_count", &RepairReport::nonfinite_triangle_count},
    {"degenerate_triangle_count", &RepairReport::degenerate_triangle_count},
    {"duplicate_triangle_count", &RepairReport::duplicate_triangle_count},
    {"computed_normal_count", &RepairReport::computed_normal_count},
    {"nonmanifold_triangle_count", &RepairReport::nonmanifold_triangle_count},
    {"nonmanifold_vertex_count", &RepairReport::nonmanifold_vertex_count},
    {"boundary_edge_count", &RepairReport::boundary_edge_count}};

nlohmann::ordered_json figures(const prt::gltf::ImportedMesh& mesh) {
  nlohmann::ordered_json json{{"vertex_count", mesh.vertex_count},
                              {"triangle_count", mesh.triangle_count}};
  for (const auto& [key, member] : kRepairKeys) json["repair"][key] = mesh.repair.*member;
  return json;
}

void report_meshes(prt::Report& report, const std::vector<prt::gltf::ImportedMesh>& meshes) {
  prt::gltf::ImportedMesh total;
  auto list = nlohmann::ordered_json::array();
  for (const prt::gltf::ImportedMesh& mesh : meshes) {
    nlohmann::ordered_json entry{{"name", mesh.name}};
    entry.update(figures(mesh));
    list.push_back(std::move(entry));
    total.vertex_count += mesh.vertex_count;
    total.triangle_count += mesh.triangle_count;
    total.repair.add(mesh.repair);
  }
  report.json().update(figures(total));
  report.json()["meshes"] = std::move(list);
  prt::log::info("{} vertices, {} triangles in {} meshes", total.vertex_count, total.triangle_count,
                 meshes.size());
  for (const auto& [key, member] : kRepairKeys) {
    if (total.repair.*member > 0) prt::log::info("  {}: {}", key, total.repair.*member);
  }
}

}  // namespace

int main(int argc, char** argv) {
  prt::cli::Tool tool("prt-import",
                      "Reads a model (.obj .ply .off .stl .gltf .glb), checks and repairs it, and "
                      "writes a .glb that the other tools can bake.",
                      "prt-import bunny.obj -o bunny.glb --base-color 0.7,0.7,0.7");
  std::filesystem::path input, output;
  prt::gltf::ImportOptions options;
  std::vector<float> base_color;
  std::string up = "y";
  CLI::App& app = tool.app();
  app.add_option("input", input, "Model to read")->required();
  app.add_option("-o,--output", output, ".glb to write")->required();

  app.add_option("--base-color", base_color,
                 "Linear R,G,B in 0..1 of what has no material of its own")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(0.0, 1.0))
      ->group("Material");

  const char* geometry = "Geometry";
  app.add_option("--max-edge", options.prepare.max_edge,
                 "Split edges longer than this many metres; 0: none")
      ->check(CLI::NonNegativeNumber)
      ->group(geometry);
  app.add_option("--max-triangles", options.prepare.max_triangles,
                 "Fail when splitting makes more, per mesh")
      ->group(geometry);
  app.add_option("--crease-angle", options.prepare.repair.crease_angle_degrees,
                 "Computed normals: edges sharper than this many degrees stay hard; 180: none")
      ->check(CLI::Range(0.0, 180.0))
      ->group(geometry);
  app.add_flag("--recompute-normals", options.prepare.repair.recompute_normals,
               "Compute normals even where the file has them")
      ->group(geometry);
  app.add_option("--unit", options.metres_per_unit, "Metres per unit of a mesh file")
      ->check(CLI::PositiveNumber)
      ->group(geometry);
  app.add_option("--up", up, "Axis that points up in a mesh file")
      ->check(CLI::IsMember({"y", "z"}))
      ->group(geometry);

  const char* limits = "Limits";
  app.add_option("--max-input-bytes", options.limits.max_file_bytes, "Largest file to read")
      ->group(limits);
  app.add_option("--max-image-pixels", options.limits.max_image_pixels, "Largest texture to read")
      ->group(limits);

  return tool.run(argc, argv, [&](prt::Report& report) {
    options.up = up == "z" ? prt::mesh::UpAxis::z : prt::mesh::UpAxis::y;
    if (!base_color.empty()) options.base_color = {base_color[0], base_color[1], base_color[2]};
    prt::cli::check_paths({input}, {{output, {".glb"}, input}}, tool.common());
    std::optional<prt::gltf::ImportResult> result;
    {
      const prt::StageTimer timer(report, "import");
      result = prt::gltf::import_file(input, options);
    }
    report.add_input(input);
    report_meshes(report, result->meshes);
    {
      const prt::StageTimer timer(report, "write");
      result->document.save_glb(output, tool.common().no_clobber);
    }
    report.add_output(output);
  });
}
