// What the command line asks for: to serve with these settings, or only to print something and end.
#pragma once

#include <string>
#include <variant>

#include "server/app/settings.hpp"

namespace talus::server {

struct Serve {
  Settings settings;
};
/// Print and end: help, version, a checked or printed configuration (status 0, standard output), or what is wrong
/// (status 2, standard error).
struct PrintAndEnd {
  std::string text;
  int status = 0;
};

/// A flag wins over the file that --config names, the file over the default.
std::variant<Serve, PrintAndEnd> parse_command_line(int argc, const char* const* argv);

}  // namespace talus::server
