// The bots of a scenario, each in its place.
#pragma once

#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "client_sample/load/bot.hpp"

namespace talus::load {

using Crowd = std::vector<std::unique_ptr<Bot>>;

/// Asks the server how high the ground is where the bots are to be; nobody has connected yet. The error is a sentence.
std::expected<Crowd, std::string> gather(Stage& stage);

}  // namespace talus::load
