// One HTTP GET, waited for. For tools; a program with many requests keeps connections of its own.
#pragma once

#include <chrono>
#include <cstddef>
#include <expected>
#include <map>
#include <string>
#include <string_view>

#include "client_sample/library/client_error.hpp"
#include "client_sample/library/server_address.hpp"

namespace talus::client {

/// Longest body taken: a chunk's is below 1 MiB, glb a little more.
inline constexpr std::size_t kHttpBodyBytesMax = 4 * 1024 * 1024;

struct HttpAnswer {
  unsigned status = 0;
  std::map<std::string, std::string> fields;  ///< names in lower case
  std::string body;
};

/// `target` begins with a slash and has no blanks. Any status is an answer; no redirect is followed.
std::expected<HttpAnswer, ClientError> http_get(const ServerAddress& server, std::string_view target,
                                                std::chrono::milliseconds timeout = std::chrono::seconds(30));

}  // namespace talus::client
