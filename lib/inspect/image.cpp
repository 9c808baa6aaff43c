#include "image/image.h"

#include "inspect/inspection.h"
#include "inspect/statistics.h"

namespace prt::inspect {

void inspect_image(const std::filesystem::path& path, Inspection& inspection) {
  const image::Image image = image::read_image(path);
  Json channels = Json::array();
  const auto channel_count = static_cast<std::size_t>(image.channel_count);
  for (std::size_t c = 0; c < channel_count; ++c) {
    std::vector<float> values;
    values.reserve(image.pixels.size() / channel_count);
    for (std::size_t i = c; i < image.pixels.size(); i += channel_count) {
      values.push_back(image.pixels[i]);
    }
    Json channel = {{"channel", c < 4 ? std::string(1, "RGBA"[c]) : std::to_string(c)}};
    channel.update(range_of(values));
    channels.push_back(channel);
  }
  inspection.json["image"] = {{"width", image.width},
                              {"height", image.height},
                              {"channel_count", image.channel_count},
                              {"channels", channels}};
}

}  // namespace prt::inspect
