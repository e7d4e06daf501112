#include "client_sample/library/fetch_world.hpp"

#include <utility>

#include "client_sample/library/http_get.hpp"

namespace talus::client {

std::expected<WorldInfo, std::string> fetch_world(const ServerAddress& server, std::string_view world) {
  const std::string target = "/v1/worlds/" + std::string(world);
  const auto answer = http_get(server, target);
  if (!answer) return std::unexpected(answer.error().message);
  if (answer->status != 200) return std::unexpected(target + ": " + error_text(answer->body));
  auto info = parse_world_info(answer->body);
  if (!info) return std::unexpected(target + ": the answer is not the manifest of a world");
  return std::move(*info);
}

}  // namespace talus::client
