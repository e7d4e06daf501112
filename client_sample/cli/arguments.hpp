// The command line of `talus`.
#pragma once

namespace talus::cli {

/// Parses, runs the command and returns the program's exit code.
int run(int argc, char** argv);

}  // namespace talus::cli
