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
    {"split_vertex_count", &RepairReport::split_vertex_count},
    {"mended_attribute_count", &RepairReport::mended_attribute_count},
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
  if (total.repair.computed_normal_count > 0) {
    prt::log::info(
        "  computed normals {} (--crease-angle changes that)",
        total.repair.split_vertex_count > 0 ? "keep sharp edges hard" : "are smooth all over");
  }
}

struct Arguments {
  std::filesystem::path input, output;
  prt::gltf::ImportOptions options;
  std::vector<float> base_color;
  std::string up = "y";
};

void add_geometry_options(prt::cli::Options& app, Arguments& arguments) {
  prt::mesh::PrepareOptions& prepare = arguments.options.prepare;
  const char* group = "Geometry";
  app.add_option("--max-edge", prepare.max_edge,
                 "Split edges longer than this many metres; 0: none")
      ->check(prt::cli::at_least_zero())
      ->group(group);
  app.add_option("--max-triangles", prepare.max_triangles,
                 "Fail when splitting makes more, per mesh")
      ->group(group);
  app.add_option("--crease-angle", prepare.repair.crease_angle_degrees,
                 "Computed normals: edges sharper than this many degrees stay hard; 180: none; "
                 "auto: 60, or none in a scan, where they are few")
      ->check(prt::cli::Range(0.0, 180.0))
      ->default_str("auto")
      ->group(group);
  app.add_flag("--recompute-normals", prepare.repair.recompute_normals,
               "Compute normals even where the file has them")
      ->group(group);
  app.add_option("--unit", arguments.options.metres_per_unit, "Metres per unit of a mesh file")
      ->check(prt::cli::above_zero())
      ->group(group);
  app.add_option("--up", arguments.up, "Axis that points up in a mesh file")
      ->check(prt::cli::IsMember({"y", "z"}))
      ->group(group);
}

void add_options(prt::cli::Options& app, Arguments& arguments) {
  app.add_option("input", arguments.input, "Model to read")->required();
  app.add_option("-o,--output", arguments.output, ".glb to write")->required();
  app.add_option("--base-color", arguments.base_color,
                 "Linear R,G,B in 0..1 of what has no material of its own")
      ->numbers(3)
      ->check(prt::cli::Range(0.0, 1.0))
      ->group("Material");
  add_geometry_options(app, arguments);
  prt::gltf::Limits& limits = arguments.options.limits;
  app.add_option("--max-input-bytes", limits.max_file_bytes, "Largest file to read")
      ->group("Limits");
  app.add_option("--max-image-pixels", limits.max_image_pixels, "Largest texture to read")
      ->group("Limits");
}

void import(Arguments& arguments, const prt::cli::CommonOptions& common, prt::Report& report) {
  prt::gltf::ImportOptions& options = arguments.options;
  const std::vector<float>& color = arguments.base_color;
  options.up = arguments.up == "z" ? prt::mesh::UpAxis::z : prt::mesh::UpAxis::y;
  if (!color.empty()) options.base_color = {color[0], color[1], color[2]};
  prt::cli::check_paths({arguments.input}, {{arguments.output, {".glb"}, arguments.input}}, common);
  std::optional<prt::StageTimer> stage(std::in_place, report, "import");
  const prt::gltf::ImportResult result = prt::gltf::import_file(arguments.input, options);
  stage.reset();
  report.add_input(arguments.input);
  report_meshes(report, result.meshes);
  stage.emplace(report, "write");
  result.document.save_glb(arguments.output, common.no_clobber);
  stage.reset();
  report.add_output(arguments.output);
}

}  // namespace

int main(int argc, char** argv) {
  prt::cli::Tool tool("prt-import",
                      "Reads a model (.obj .ply .off .stl .gltf .glb), checks and repairs it, and "
                      "writes a .glb that the other tools can bake.",
                      "prt-import bunny.obj -o bunny.glb --base-color 0.7,0.7,0.7");
  Arguments arguments;
  add_options(tool.options(), arguments);
  return tool.run(argc, argv,
                  [&](prt::Report& report) { import(arguments, tool.common(), report); });
}
