// Shared by the two kinds of contexts.
#pragma once

namespace prt::gl {

/// Sends the messages of the current context's driver to the log, where it can.
void enable_driver_messages();

}  // namespace prt::gl
