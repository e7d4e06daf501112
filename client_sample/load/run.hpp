// A whole run: who comes when, one thread that drives them all, what the server says of itself, and the comparison.
#pragma once

#include <expected>
#include <functional>
#include <optional>
#include <string>

#include "client_sample/load/report.hpp"
#include "client_sample/load/scenario.hpp"

namespace talus::load {

struct RunOptions {
  client::ServerAddress http;
  client::ServerAddress tcp;                   ///< only for groups over TCP
  std::optional<client::ServerAddress> admin;  ///< whose /metrics are read before and after
  std::string world = "default";
  std::function<void(const std::string&)> on_line;  ///< once a second, how far it is
  std::function<bool(const Report&)> is_over;       ///< ends the run early
};

/// Ends after scenario.seconds and what saying goodbye takes. The error is a sentence: the run could not begin.
std::expected<Report, std::string> run(const Scenario& scenario, const RunOptions& options);

}  // namespace talus::load
