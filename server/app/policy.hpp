// From settings to what the doors go by while the server runs.
#pragma once

#include <expected>
#include <string>

#include "server/app/settings.hpp"
#include "server/net/net_policy.hpp"

namespace talus::server {

/// Reads the files that the settings name. Every fault, one a line.
std::expected<PolicyRef, std::string> make_policy(const Settings& settings);

}  // namespace talus::server
