#include "inspect/schema.h"
namespace prt::inspect { std::vector<std::string> schema_violations(const std::filesystem::path&) { return {}; } }
