// Somebody at the server's door. Owner: the thread of the loop.
#pragma once

#include <chrono>

#include <glm/vec3.hpp>

#include "client_sample/library/connection.hpp"
#include "client_sample/library/world_info.hpp"
#include "client_sample/load/report.hpp"
#include "client_sample/load/samples.hpp"
#include "client_sample/load/scenario.hpp"

namespace talus::load {

/// What all bots of a run share. Outlives them.
struct Stage {
  client::Loop& loop;
  client::ServerAddress http;
  client::ServerAddress tcp;
  client::WorldInfo world;
  const Scenario& scenario;
  Report& report;
  Samples& samples;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

  /// Seconds since the run began.
  double now_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); }
};

class Bot {
 public:
  virtual ~Bot() = default;
  /// About a hundred times a second; seconds since the run began.
  virtual void tick(double now_s) = 0;
  /// Says goodbye; nothing is counted as broken any more.
  virtual void leave() = 0;
  virtual bool is_connected() const = 0;

  Bot() = default;
  Bot(const Bot&) = delete;
  Bot& operator=(const Bot&) = delete;
};

/// A way there and back again, at `speed`; standing still without speed or length.
struct Way {
  glm::dvec3 from{};
  glm::dvec3 to{};
  double speed_m_s = 0;

  glm::dvec3 at(double seconds) const;
  glm::dvec3 velocity(double seconds) const;
};

}  // namespace talus::load
