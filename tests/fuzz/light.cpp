// Light files: whatever the bytes, a valid light or Error.
#include "sh/light.h"

#include "core/error.h"
#include "fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  const prt::FuzzFile file(bytes, count);
  try {
    const prt::sh::Light light = prt::sh::read_light(file.path());
    if (light.coefficients[0].empty()) std::abort();
  } catch (const prt::Error&) {
  }
  return 0;
}
