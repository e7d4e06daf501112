// One HTTP GET, waited for. For tools; a program with many requests uses an HttpClient.
#pragma once

#include <chrono>
#include <expected>
#include <string_view>

#include "client_sample/library/client_error.hpp"
#include "client_sample/library/http_reader.hpp"
#include "client_sample/library/server_address.hpp"

namespace talus::client {

/// `target` begins with a slash and has no blanks. Any status is an answer; no redirect is followed.
std::expected<HttpAnswer, ClientError> http_get(const ServerAddress& server, std::string_view target,
                                                std::chrono::milliseconds timeout = std::chrono::seconds(30));

}  // namespace talus::client
