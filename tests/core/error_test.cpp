#include "core/error.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

TEST(Error, MessageNamesFileElementFoundExpectedAndAdvice) {
  const Error error(ErrorKind::bad_input, "index out of range",
                    {.file = "a.obj",
                     .element = "line 3",
                     .found = "9",
                     .expected = "at most 4",
                     .advice = "Export the mesh again."});
  EXPECT_STREQ(error.what(),
               "a.obj: line 3: index out of range: found 9, expected at most 4. Export the mesh "
               "again.");
  EXPECT_EQ(error.exit_status(), 3);
}

}  // namespace
}  // namespace prt
