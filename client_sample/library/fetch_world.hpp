// What a server says of one of its worlds, waited for. For tools: a stream's welcome brings the same.
#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "client_sample/library/server_address.hpp"
#include "client_sample/library/world_info.hpp"

namespace talus::client {

/// The error is a sentence: no connection, no such world, or no manifest.
std::expected<WorldInfo, std::string> fetch_world(const ServerAddress& server, std::string_view world);

}  // namespace talus::client
