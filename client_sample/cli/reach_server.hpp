// From the options of a command to the server it talks to. Says on standard error what cannot be used.
#pragma once

#include <expected>

#include "client_sample/cli/commands.hpp"
#include "client_sample/library/server_address.hpp"

namespace talus::cli {

std::expected<client::ServerAddress, ExitCode> reach_server(const ServerOptions& options);

}  // namespace talus::cli
