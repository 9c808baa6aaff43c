#include "core/reference.h"

#include "error_of.h"
#include "temporary_folder.h"

namespace prt {
namespace {

namespace fs = std::filesystem;

TEST(ResolveReference, GivesTheRealPathInsideTheFolder) {
  const TemporaryFolder folder;
  const fs::path real = fs::canonical(folder.path());
  fs::create_directory(folder / "sub");
  folder.write("sub/b c.bin", "");
  fs::create_symlink("sub/b c.bin", folder / "link.bin");
  const fs::path file = folder / "a.gltf";
  EXPECT_EQ(resolve_reference(file, "sub/b%20c.bin", Escapes::percent), real / "sub" / "b c.bin");
  EXPECT_EQ(resolve_reference(file, "sub\\b c.bin", Escapes::none), real / "sub" / "b c.bin");
  EXPECT_EQ(resolve_reference(file, "missing.bin", Escapes::none), real / "missing.bin");
  // Exchanging the link after the check changes nothing.
  EXPECT_EQ(resolve_reference(file, "link.bin", Escapes::none), real / "sub" / "b c.bin");
}

TEST(ResolveReference, TakesTheCurrentFolderForThatOfABareName) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  const fs::path found = resolve_reference("a.gltf", "missing.bin", Escapes::none);
  fs::current_path(before);
  EXPECT_EQ(found, fs::canonical(folder.path()) / "missing.bin");
}

TEST(ResolveReference, RefusesWhatLeavesTheFolder) {
  const TemporaryFolder folder;
  fs::create_symlink("/etc/hostname", folder / "link");
  fs::create_directory_symlink("/etc", folder / "etc");
  const fs::path file = folder / "a.gltf";
  for (const char* name : {"", "/etc/hostname", "../a", "b/../../a", "%2e%2e/a", "..\\a", "C:a",
                           "file:a", "link", "etc/hostname"}) {
    EXPECT_HAS(error_of([&] { resolve_reference(file, name, Escapes::percent); }),
               "inside the file's own folder")
        << name;
  }
}

}  // namespace
}  // namespace prt
