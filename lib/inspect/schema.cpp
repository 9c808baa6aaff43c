#include "inspect/schema.h"

#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "core/error.h"
#include "core/file.h"
#include "gltf/precomputed_transfer.h"
#include "inspect/schema_texts.h"

namespace prt::inspect {

namespace {

using gltf::kTransferExtension;

using Plain = nlohmann::json;
using Adapter = valijson::adapters::NlohmannJsonAdapter;

constexpr const char* kRootSchema = "glTF.PRTKIT_precomputed_transfer.schema.json";
constexpr const char* kPrimitiveSchema = "mesh.primitive.PRTKIT_precomputed_transfer.schema.json";

// Our schemas, and what they use of glTF's own.
Plain schema_json(std::string_view name) {
  if (name == "glTFProperty.schema.json") return {{"type", "object"}};
  if (name == "glTFid.schema.json") return {{"type", "integer"}, {"minimum", 0}};
  for (const SchemaText& schema : kSchemaTexts) {
    if (name == schema.name) return Plain::parse(schema.text);
  }
  throw_failed(fmt::format("no schema {}", name));
}

void validate(const char* schema_name, const Plain& value, const std::string& element,
              std::vector<std::string>& violations) {
  const Plain json = schema_json(schema_name);
  valijson::Schema schema;
  valijson::SchemaParser parser;
  const auto fetch = [](const std::string& uri) -> const Plain* {
    return new Plain(schema_json(uri));
  };
  const auto release = [](const Plain* document) { delete document; };
  parser.populateSchema(Adapter(json), schema, fetch, release);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(schema, Adapter(value), &results)) return;
  valijson::ValidationResults::Error error;
  while (results.popError(error)) {
    std::string place = element;
    // The context starts with "<root>", then "[name]" each.
    for (std::size_t i = 1; i < error.context.size(); ++i) place += error.context[i];
    violations.push_back(place + ": " + error.description);
  }
}

// The JSON chunk of a .glb, or the whole of a .gltf.
Plain read_json(const std::filesystem::path& path) {
  const std::string bytes = read_text_file(path);
  std::string_view text(bytes);
  constexpr std::size_t kHeaderBytes = 20;  // file header, then the first chunk's length and type
  if (text.starts_with("glTF")) {
    std::uint32_t length = 0;
    if (text.size() >= kHeaderBytes) std::memcpy(&length, text.data() + 12, sizeof(length));
    if (length == 0 || length > text.size() - kHeaderBytes) {
      throw_bad_input("the JSON chunk runs past the end", {.file = path.string()});
    }
    text = text.substr(kHeaderBytes, length);
  }
  Plain json = Plain::parse(text, nullptr, false);
  if (!json.is_object()) throw_bad_input("holds no JSON object", {.file = path.string()});
  return json;
}

const Plain* extension_of(const Plain& object) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end() || !extensions->is_object()) return nullptr;
  const auto extension = extensions->find(kTransferExtension);
  return extension == extensions->end() ? nullptr : &*extension;
}

// Elements of an array property; none when it is absent or something else.
const Plain& array_of(const Plain& object, const char* name) {
  static const Plain empty = Plain::array();
  if (!object.is_object()) return empty;
  const auto array = object.find(name);
  return array == object.end() || !array->is_array() ? empty : *array;
}

}  // namespace

std::vector<std::string> schema_violations(const std::filesystem::path& path) {
  const Plain json = read_json(path);
  std::vector<std::string> violations;
  if (const Plain* extension = extension_of(json)) {
    validate(kRootSchema, *extension, kTransferExtension, violations);
  }
  const Plain& meshes = array_of(json, "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const Plain& primitives = array_of(meshes[m], "primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      if (!primitives[p].is_object()) continue;
      if (const Plain* extension = extension_of(primitives[p])) {
        validate(kPrimitiveSchema, *extension, fmt::format("mesh {}: primitive {}", m, p),
                 violations);
      }
    }
  }
  return violations;
}

}  // namespace prt::inspect
