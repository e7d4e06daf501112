// Ctrl-C ends a long run in an orderly way: what it has done is printed or stored first.
#pragma once

namespace talus::cli {

/// From now on a SIGINT is remembered instead of ending the process at once; a second one ends it.
void catch_interrupt();
/// Whether one came since.
bool is_interrupted();

}  // namespace talus::cli
