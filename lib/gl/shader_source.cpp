#include "gl/shader_source.h"

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>

#include "core/error.h"
#include "core/file.h"

namespace prt::gl {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxShaderBytes = 1 << 20;

void append(const fs::path& path, ShaderSource& source) {
  if (std::find(source.files.begin(), source.files.end(), path) != source.files.end()) return;
  const std::size_t file_number = source.files.size();
  source.files.push_back(path);
  if (!fs::exists(path))
    throw_failed("no such shader", {.file = path.string(),
                                    .advice = "PRTKIT_SHADER_DIR can name the folder of shaders."});
  static const std::regex include(R"re(\s*#include\s+"([^"]+)"\s*)re");
  std::istringstream lines(read_text_file(path, kMaxShaderBytes));
  std::string line;
  source.text += "#line 1 " + std::to_string(file_number) + "\n";
  for (int number = 1; std::getline(lines, line); ++number) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) {
      source.text += line + "\n";
      continue;
    }
    append(path.parent_path() / match[1].str(), source);
    source.text += "#line " + std::to_string(number + 1) + " " + std::to_string(file_number) + "\n";
  }
}

}  // namespace

fs::path shader_folder() {
  if (const char* folder = std::getenv("PRTKIT_SHADER_DIR")) return folder;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share/prtkit/shaders";
  if (!error && fs::is_directory(installed, error)) return installed;
  return PRTKIT_SHADER_DIR;
}

ShaderSource load_shader_source(const std::string& file, const Defines& defines, bool es) {
  ShaderSource source;
  source.text = es ? "#version 300 es\n"
                     "precision highp float;\nprecision highp int;\n"
                     "precision highp sampler2D;\nprecision highp sampler2DArray;\n"
                   : "#version 330 core\n";
  for (const std::string& define : defines) source.text += "#define " + define + "\n";
  append(shader_folder() / file, source);
  return source;
}

std::string with_file_names(const std::string& log, const std::vector<fs::path>& files) {
  static const std::regex place(R"(^((?:ERROR|WARNING): )?(\d+)[:(](\d+)\)?)");
  std::istringstream lines(log);
  std::string line, result;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (std::regex_search(line, match, place)) {
      const std::size_t file = std::stoul(match[2].str());
      if (file < files.size())
        line = match[1].str() + files[file].filename().string() + ":" + match[3].str() +
               match.suffix().str();
    }
    result += line + "\n";
  }
  return result;
}

}  // namespace prt::gl
