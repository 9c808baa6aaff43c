#include "core/report.h"

#include <sys/resource.h>

#include "core/atomic_file.h"
#include "core/cpu.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace prt {

namespace {

void add_file(nlohmann::ordered_json& list, const std::filesystem::path& path) {
  list.push_back({{"path", path.string()},
                  {"bytes", std::filesystem::file_size(path)},
                  {"hash", hash_file(path)}});
}

}  // namespace

Report::Report(std::string tool) {
  json_["tool"] = std::move(tool);
  json_["version"] = PRTKIT_VERSION;
  json_["options"] = nlohmann::ordered_json::object();
  json_["inputs"] = nlohmann::ordered_json::array();
  json_["outputs"] = nlohmann::ordered_json::array();
  json_["stages"] = nlohmann::ordered_json::array();
}

void Report::add_input(const std::filesystem::path& path) {
  check_input(path);
  add_file(json_["inputs"], path);
}

void Report::add_output(const std::filesystem::path& path) { add_file(json_["outputs"], path); }

void Report::add_stage(const std::string& name, double seconds) {
  json_["stages"].push_back({{"name", name}, {"seconds", seconds}});
}

void Report::write(const std::filesystem::path& path, bool no_clobber) {
  json_["seconds"] = stopwatch_.seconds();
  json_["peak_memory_bytes"] = peak_memory_bytes();
  json_["threads"] = thread_count();
  json_["simd"] = simd_level_name(simd_level());
  AtomicFile file(path, no_clobber);
  file.write(json_text(json_, 2) + "\n");
  file.commit();
}

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace prt
