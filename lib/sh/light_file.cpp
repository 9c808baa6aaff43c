#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "sh/basis.h"
#include "sh/light.h"

namespace prt::sh {

namespace {

using nlohmann::json;

constexpr int kVersion = 1;
constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
constexpr int kMaxDepth = 16;
constexpr const char* kChannels[] = {"r", "g", "b"};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path.string()) {
    const std::string text = read_text_file(path, kMaxBytes);
    const auto limit_depth = [this](int depth, json::parse_event_t, json&) {
      if (depth > kMaxDepth) throw_bad_input("nested too deeply", {.file = file_});
      return true;
    };
    try {
      root_ = json::parse(text, limit_depth);
    } catch (const json::exception& error) {
      throw_bad_input("not a light file: no valid JSON",
                      {.file = file_, .found = error.what(), .expected = "JSON by prt-light"});
    }
    if (!root_.is_object()) reject("the file", root_.type_name(), "an object");
  }

  Light read() const {
    const std::int64_t version = integer("prtkit_light");
    if (version != kVersion) {
      reject("\"prtkit_light\"", fmt::format("{}", version), fmt::format("{}", kVersion));
    }
    const std::int64_t band_count = integer("band_count");
    if (band_count < 1 || band_count > kMaxBandCount) {
      reject("\"band_count\"", fmt::format("{}", band_count),
             fmt::format("1 to {}", kMaxBandCount));
    }
    Light light(static_cast<int>(band_count));
    if (root_.contains("source")) {
      if (!root_["source"].is_string()) {
        reject("\"source\"", root_["source"].type_name(), "a string");
      }
      light.source = root_["source"].get<std::string>();
    }
    const json& channels = member(root_, "coefficients", "\"coefficients\"");
    if (!channels.is_object()) reject("\"coefficients\"", channels.type_name(), "an object");
    for (std::size_t c = 0; c < 3; ++c) {
      const std::string element = fmt::format("\"coefficients\".\"{}\"", kChannels[c]);
      read_channel(member(channels, kChannels[c], element), element, light.coefficients[c]);
    }
    return light;
  }

 private:
  [[noreturn]] void reject(const std::string& element, const std::string& found,
                           const std::string& expected) const {
    throw_bad_input("not a valid light file",
                    {.file = file_, .element = element, .found = found, .expected = expected});
  }

  const json& member(const json& object, const char* key, const std::string& element) const {
    const auto found = object.find(key);
    if (found == object.end()) reject(element, "nothing", "a value");
    return *found;
  }

  std::int64_t integer(const char* key) const {
    const std::string element = fmt::format("\"{}\"", key);
    const json& value = member(root_, key, element);
    if (!value.is_number_integer()) reject(element, value.type_name(), "an integer");
    return value.get<std::int64_t>();
  }

  void read_channel(const json& values, const std::string& element,
                    std::vector<float>& channel) const {
    if (!values.is_array()) reject(element, values.type_name(), "an array");
    if (values.size() != channel.size()) {
      reject(element, fmt::format("{} numbers", values.size()),
             fmt::format("{}, the square of \"band_count\"", channel.size()));
    }
    for (std::size_t i = 0; i < channel.size(); ++i) {
      const std::string where = fmt::format("{}[{}]", element, i);
      if (!values[i].is_number()) reject(where, values[i].type_name(), "a number");
      channel[i] = values[i].get<float>();
      if (!std::isfinite(channel[i])) reject(where, values[i].dump(), "a finite float32");
    }
  }

  std::string file_;
  json root_;
};

}  // namespace

Light read_light(const std::filesystem::path& path) { return Reader(path).read(); }

void write_light(const std::filesystem::path& path, const Light& light, bool no_clobber) {
  for (const auto& channel : light.coefficients) {
    for (float value : channel) {
      if (!std::isfinite(value)) {
        throw_failed("a coefficient of the light is not finite", {.file = path.string()});
      }
    }
  }
  std::string text = fmt::format("{{\n  \"prtkit_light\": {},\n  \"band_count\": {},\n", kVersion,
                                 light.band_count);
  text += fmt::format("  \"source\": {},\n  \"coefficients\": {{\n",
                      json(light.source).dump(-1, ' ', false, json::error_handler_t::replace));
  for (std::size_t c = 0; c < 3; ++c) {
    text += fmt::format("    \"{}\": [{}]{}\n", kChannels[c],
                        fmt::join(light.coefficients[c], ", "), c < 2 ? "," : "");
  }
  text += "  }\n}\n";
  AtomicFile file(path, no_clobber);
  file.write(text);
  file.commit();
}

}  // namespace prt::sh
