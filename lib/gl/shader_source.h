// The text of shaders before OpenGL sees it; no OpenGL here.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gl/program.h"

namespace prt::gl {

struct ShaderSource {
  std::string text;
  std::vector<std::filesystem::path> files;  ///< what `#line L F` in the text numbers
};

/// Reads a file of shader_folder() with all it includes, each file once. Throws Error (failed) when
/// one is missing.
ShaderSource load_shader_source(const std::string& file, const Defines& defines, bool es);

/// A compiler's log with "F:L" or "F(L)" at the start of a line made "name:L".
std::string with_file_names(const std::string& log,
                            const std::vector<std::filesystem::path>& files);

}  // namespace prt::gl
