#include "mesh/mtl.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/log.h"
#include "core/reference.h"
#include "mesh/text.h"

namespace prt::mesh {

namespace {

constexpr std::size_t kMaxLibraryBytes = std::size_t{64} << 20;

class LibraryReader {
 public:
  LibraryReader(const std::filesystem::path& path, const ReadLimits& limits, Scene& scene,
                std::map<std::string, int>& materials)
      : path_(path), limits_(limits), scene_(scene), materials_(materials) {}

  void read(std::string_view text) {
    LineReader lines(text);
    while (auto line = lines.next()) {
      const std::string_view key = take_word(*line);
      if (key == "newmtl") {
        begin_material(std::string(trimmed(*line)));
      } else if (current_ && key == "Kd") {
        read_color(*line, lines.line_number());
      } else if (current_ && key == "map_Kd") {
        read_texture(trimmed(*line));
      }
    }
  }

 private:
  void begin_material(const std::string& name) {
    current_ = materials_.emplace(name, static_cast<int>(scene_.materials.size())).second;
    if (current_) scene_.materials.push_back({.name = name});
  }

  void read_color(std::string_view line, std::size_t line_number) {
    Vec4& color = scene_.materials.back().base_color;
    for (int c = 0; c < 3; ++c) {
      const auto value = to_float(take_word(line));
      if (!value || !std::isfinite(*value)) {
        log::warning("{}: line {}: colour that is no three numbers, ignored", path_.string(),
                     line_number);
        color = Vec4(1.0f);
        return;
      }
      color[c] = std::clamp(*value, 0.0f, 1.0f);
    }
  }

  std::size_t pixels_left() const {
    std::size_t left = limits_.max_image_pixels;
    for (const image::Image& image : scene_.images) left -= image.pixel_count();
    return left;
  }

  void read_texture(std::string_view name) {
    if (name.starts_with('-')) {  // options before the name; a name after them has no spaces
      const std::size_t space = name.find_last_of(" \t");
      name = space == name.npos ? std::string_view() : name.substr(space + 1);
    }
    const auto [known, added] = images_.try_emplace(std::string(name), -1);
    if (added) {
      try {
        image::Image image =
            image::read_image(resolve_reference(path_, name, Escapes::none), pixels_left());
        known->second = static_cast<int>(scene_.images.size());
        scene_.images.push_back(std::move(image));
      } catch (const Error& error) {
        log::warning("texture ignored: {}", error.what());
      }
    }
    scene_.materials.back().base_color_image = known->second;
  }

  const std::filesystem::path& path_;
  const ReadLimits& limits_;
  Scene& scene_;
  std::map<std::string, int>& materials_;
  std::map<std::string, int> images_;
  bool current_ = false;
};

}  // namespace

void read_material_library(const std::filesystem::path& obj, std::string_view name,
                           const ReadLimits& limits, Scene& scene,
                           std::map<std::string, int>& materials) {
  const std::filesystem::path path = resolve_reference(obj, name, Escapes::none);
  std::string text;
  try {
    text = read_text_file(path, kMaxLibraryBytes);
  } catch (const Error& error) {
    log::warning("material library ignored: {}", error.what());
    return;
  }
  LibraryReader(path, limits, scene, materials).read(text);
}

}  // namespace prt::mesh
