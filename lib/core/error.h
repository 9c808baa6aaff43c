// The one exception type of prtkit. Readers and drivers throw it; each main catches it once and
// turns its kind into the exit status of docs/architecture.md, "Command line".
#pragma once

#include <stdexcept>
#include <string>

namespace prt {

/// Exit statuses of every tool: 1 the work failed, 2 wrong usage, 3 bad input file.
enum class ErrorKind { failed = 1, usage = 2, bad_input = 3 };

/// What went wrong, where, and what to do about it. Empty fields are left out of the message.
struct ErrorDetails {
  std::string file{};      ///< path of the file, as the user gave it
  std::string element{};   ///< "accessor 3", "vertex 17", "line 12", …
  std::string found{};     ///< what stood there
  std::string expected{};  ///< what should have stood there
  std::string advice{};    ///< what the user can do
};

class Error : public std::runtime_error {
 public:
  /// The message reads "file: element: what: found …, expected …. Advice".
  Error(ErrorKind error_kind, const std::string& what, const ErrorDetails& error_details = {});

  ErrorKind kind() const { return kind_; }
  int exit_status() const { return static_cast<int>(kind_); }
  const ErrorDetails& details() const { return details_; }

 private:
  ErrorKind kind_;
  ErrorDetails details_;
};

/// Shorthands for the two common kinds.
[[noreturn]] void throw_bad_input(const std::string& what, const ErrorDetails& details = {});
[[noreturn]] void throw_failed(const std::string& what, const ErrorDetails& details = {});

}  // namespace prt
