#include "core/error.h"

namespace prt {

namespace {

std::string compose(const std::string& what, const ErrorDetails& details) {
  std::string message;
  if (!details.file.empty()) message += details.file + ": ";
  if (!details.element.empty()) message += details.element + ": ";
  message += what;
  if (!details.found.empty()) message += ": found " + details.found;
  if (!details.expected.empty()) {
    message += (details.found.empty() ? ": expected " : ", expected ") + details.expected;
  }
  if (!details.advice.empty()) message += ". " + details.advice;
  return message;
}

}  // namespace

Error::Error(ErrorKind error_kind, const std::string& what, const ErrorDetails& error_details)
    : std::runtime_error(compose(what, error_details)),
      kind_(error_kind),
      details_(error_details) {}

void throw_bad_input(const std::string& what, const ErrorDetails& details) {
  throw Error(ErrorKind::bad_input, what, details);
}

void throw_failed(const std::string& what, const ErrorDetails& details) {
  throw Error(ErrorKind::failed, what, details);
}

}  // namespace prt
