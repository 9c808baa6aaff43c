// Ways to break a correct file, and what is then said.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>

#include "error_of.h"
#include "gltf/document.h"
#include "gltf/samples.h"

namespace prt::gltf {

using nlohmann::ordered_json;
using prt::error_of;

inline std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

/// What loading, or else looking at the scene, ends in.
inline std::string error_of(const ordered_json& json) {
  return prt::error_of([&] { samples::parse(json).scene(); });
}

inline ordered_json with(const char* pointer, const ordered_json& value) {
  ordered_json json = samples::triangle_json();
  json[ordered_json::json_pointer(pointer)] = value;
  return json;
}

}  // namespace prt::gltf

#define EXPECT_ERROR(json, part) EXPECT_HAS(error_of(json), part)
