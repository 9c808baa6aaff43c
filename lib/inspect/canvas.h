// Just enough drawing for plots: rectangles and text.
#pragma once

#include <string>

#include "core/vec.h"
#include "image/image.h"

namespace prt::inspect {

/// Colours are display (sRGB) values in [0, 1].
inline const Vec3 kBlack(0.1f), kWhite(1.0f), kGray(0.85f);

/// What falls outside is cut off.
class Canvas {
 public:
  Canvas(int width, int height, const Vec3& background);

  int width() const { return pixels_.width; }
  int height() const { return pixels_.height; }
  void fill(int x, int y, int width, int height, const Vec3& color);
  /// ASCII, upper left corner at (x, y), about 12 pixels high.
  void text(int x, int y, const std::string& text, const Vec3& color);
  static int text_width(const std::string& text);

  /// The picture in linear values, as image::write_image takes it.
  image::Image linear() const;

 private:
  image::Image pixels_;
};

}  // namespace prt::inspect
