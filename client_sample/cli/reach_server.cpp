#include "client_sample/cli/reach_server.hpp"

#include <fmt/format.h>

namespace talus::cli {

std::expected<client::ServerAddress, ExitCode> reach_server(const ServerOptions& options) {
  auto server = client::parse_server_url(options.url);
  if (!server) {
    fmt::print(stderr, "talus: {}\n", server.error().message);
    return std::unexpected(kUsage);
  }
  server->ca_file = options.ca_file;
  server->token = options.token;
  return std::move(*server);
}

}  // namespace talus::cli
