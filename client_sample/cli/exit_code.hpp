// What the program returns. Part of its interface: `talus --help` lists them.
#pragma once

namespace talus::cli {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,     ///< the server, the network or a file did not do its part
  kUsage = 2,      ///< the command line is wrong
  kNoSurface = 3,  ///< the chunk is all air or all rock: there is nothing to write
  kBadManifest = 4,
  kIncomplete = 5,  ///< fly: a viewer failed, or its view was not complete when the time was up
};

}  // namespace talus::cli
