// Whole files into memory, with a size limit, for readers that check before they parse.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace prt {

/// What is read of a file at most, unless a reader says otherwise.
constexpr std::size_t kMaxInputBytes = std::size_t{8} << 30;

/// Throws Error (bad_input) when `path` is missing or not a regular file.
void check_input(const std::filesystem::path& path);

/// Bytes of a regular file. Throws Error (bad_input) when it is missing, a folder, or larger than
/// `limit` bytes.
std::vector<std::byte> read_file(const std::filesystem::path& path,
                                 std::size_t limit = kMaxInputBytes);
std::string read_text_file(const std::filesystem::path& path, std::size_t limit = kMaxInputBytes);

/// The ending of the file's name with its dot, ASCII letters in lower case: ".exr" for a.EXR.
std::string lower_extension(const std::filesystem::path& path);

/// The folder that the file is in; "." of a bare name.
std::filesystem::path folder_of(const std::filesystem::path& path);

}  // namespace prt
