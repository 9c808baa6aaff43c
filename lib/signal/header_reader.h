// Checks an OpenEXR header against docs/transfer-file.md, field by field, before any memory is
// taken for pixels.
#pragma once

#include <ImfHeader.h>

#include <string>

#include "signal/layout.h"

namespace prt::signal {

class HeaderReader {
 public:
  /// `file` is the path for messages. Both must outlive this.
  HeaderReader(const Imf::Header& header, const std::string& file) : header_(header), file_(file) {}

  /// A signal with everything but its values. Throws Error (bad_input) when an attribute is
  /// missing, of another type or out of range, when the channels are not the expected ones, when
  /// the window does not fit the vertex counts, or when the values would take more than
  /// `max_bytes` or cannot come from a file of `file_bytes`.
  TransferSignal read(std::size_t file_bytes, std::size_t max_bytes) const;

 private:
  [[noreturn]] void reject(const std::string& element, const std::string& found,
                           const std::string& expected) const;
  template <class Attribute>
  const auto& attribute(const char* name) const;
  int int_attribute(const char* name, int lowest, int highest) const;
  std::uint64_t parse_count(const char* name, const std::string& text) const;

  void read_attributes(TransferSignal& signal) const;
  void read_blocks(TransferSignal& signal) const;
  void check_kind() const;
  void check_channels(const TransferSignal& signal) const;
  void check_window(const TransferSignal& signal) const;
  void check_size(const TransferSignal& signal, std::size_t file_bytes,
                  std::size_t max_bytes) const;

  const Imf::Header& header_;
  const std::string& file_;
};

}  // namespace prt::signal
