#include "inspect/canvas.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace prt::inspect {

namespace {

// stb_easy_font gives four corners a rectangle: x, y, z, colour, 16 bytes each.
struct TextCorner {
  float x, y, z;
  unsigned char color[4];
};
static_assert(sizeof(TextCorner) == 16);

constexpr std::size_t kBytesPerCharacter = 400;  // stb_easy_font's own estimate is 270

}  // namespace

Canvas::Canvas(int width, int height, const Vec3& background) : pixels_(width, height, 3) {
  fill(0, 0, width, height, background);
}

void Canvas::fill(int x, int y, int width, int height, const Vec3& color) {
  for (int j = std::max(y, 0); j < std::min(y + height, pixels_.height); ++j) {
    for (int i = std::max(x, 0); i < std::min(x + width, pixels_.width); ++i) {
      for (int c = 0; c < 3; ++c) pixels_.at(i, j)[c] = color[c];
    }
  }
}

void Canvas::text(int x, int y, const std::string& text, const Vec3& color) {
  std::string copy = text;  // stb takes char*, and printable ASCII only
  for (char& c : copy) {
    if (c < ' ' || c > '~') c = '?';
  }
  std::vector<TextCorner> corners((copy.size() + 1) * kBytesPerCharacter / sizeof(TextCorner));
  const int count = stb_easy_font_print(0.0f, 0.0f, copy.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(TextCorner)));
  for (int i = 0; i < count; ++i) {
    const TextCorner& low = corners[static_cast<std::size_t>(4 * i)];
    const TextCorner& high = corners[static_cast<std::size_t>(4 * i + 2)];
    fill(x + static_cast<int>(low.x), y + static_cast<int>(low.y), static_cast<int>(high.x - low.x),
         static_cast<int>(high.y - low.y), color);
  }
}

int Canvas::text_width(const std::string& text) {
  std::string copy = text;
  return stb_easy_font_width(copy.data());
}

image::Image Canvas::linear() const {
  image::Image image = pixels_;
  for (float& value : image.pixels) {
    value = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
  }
  return image;
}

}  // namespace prt::inspect
