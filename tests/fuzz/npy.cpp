// The reader of .npy files against any bytes: an error or a matrix, never a crash.
#include "signal/npy.h"

#include "core/error.h"
#include "fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  const prt::FuzzFile file(bytes, count);
  try {
    const auto matrix = prt::signal::read_npy(file.path(), std::size_t{1} << 26);
    if (matrix.values.size() != matrix.row_count * matrix.column_count) std::abort();
  } catch (const prt::Error&) {
  }
  return 0;
}
