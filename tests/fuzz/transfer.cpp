// The reader of transfer files against any bytes: an error or a signal, never a crash.
#include "core/error.h"
#include "fuzz_file.h"
#include "signal/transfer_signal.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  const prt::FuzzFile file(bytes, count);
  try {
    const auto signal = prt::signal::read_transfer(file.path(), std::size_t{1} << 26);
    if (signal.values.size() !=
        signal.vertex_count() * static_cast<std::size_t>(signal.dimension())) {
      std::abort();
    }
  } catch (const prt::Error&) {
  }
  return 0;
}
