// talus fly: headless viewers that follow a path, and what they saw.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/flight.hpp"
#include "client_sample/cli/interrupt.hpp"
#include "client_sample/cli/reach_server.hpp"
#include "client_sample/cli/text.hpp"
#include "client_sample/library/http_get.hpp"
#include "client_sample/library/world_info.hpp"

namespace talus::cli {
namespace {

using Clock = std::chrono::steady_clock;
using Flights = std::vector<std::unique_ptr<Flight>>;

/// A viewer tells where it is ten times a second, as the browser viewer does.
constexpr std::chrono::milliseconds kTick{100};
/// Viewers beside each other are this far apart, so that they share coarse chunks and not fine ones.
constexpr double kViewerSpacing_m = 300.0;
/// Above the standing place a flight without --from begins at.
constexpr double kEyes_m = 2.0;

struct Path {
  glm::dvec3 from{};
  glm::dvec3 way{};  ///< metres per second
  double duration_s = 0.0;

  glm::dvec3 at(double seconds) const { return from + way * std::min(seconds, duration_s); }
  glm::dvec3 velocity(double seconds) const { return seconds < duration_s ? way : glm::dvec3{}; }
};

/// Where a flight without --from begins: a standing place near the origin.
glm::dvec3 spawn(const client::ServerAddress& server, const std::string& world) {
  const auto answer = client::http_get(server, "/v1/worlds/" + world + "/spawn?near=0,0");
  const auto place = answer && answer->status == 200 ? client::parse_spawn(answer->body) : std::nullopt;
  return place ? *place + glm::dvec3{0, kEyes_m, 0} : glm::dvec3{0, 300, 0};
}

std::optional<Path> path_of(const FlyOptions& options, const client::ServerAddress& server) {
  Path out;
  const auto from = options.from.empty() ? spawn(server, options.server.world) : parse_place(options.from);
  const auto to = options.to.empty() ? from : parse_place(options.to);
  if (!from || !to) {
    fmt::print(stderr, "talus: \"{}\" is not a place: give three numbers of metres as 100,250,-40\n",
               from ? options.to : options.from);
    return std::nullopt;
  }
  out.from = *from;
  const glm::dvec3 way = *to - *from;
  const double length = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
  if (length > 0 && options.speed > 0) {
    out.duration_s = length / options.speed;
    out.way = way * (options.speed / length);
  }
  return out;
}

Flights take_off(client::Loop& loop, const FlyOptions& options, const client::ServerAddress& server) {
  Flights out;
  client::StreamOptions stream;
  stream.server = server;
  stream.world = options.server.world;
  stream.client = "talus fly";
  stream.credit_bytes = options.credit_bytes;
  for (int i = 0; i < options.viewers; ++i) out.push_back(std::make_unique<Flight>(loop, stream, options.decodes));
  return out;
}

void look_from(Flights& flights, const FlyOptions& options, const Path& path, double seconds) {
  for (std::size_t i = 0; i < flights.size(); ++i) {
    if (flights[i]->is_over()) continue;
    protocol::View view;
    view.position = path.at(seconds) + glm::dvec3{kViewerSpacing_m * static_cast<double>(i), 0, 0};
    view.velocity = path.velocity(seconds);
    if (path.duration_s > 0) view.direction = path.way;
    view.near_m = options.near_m;
    view.far_m = options.far_m;
    view.lod_bias = options.lod_bias;
    flights[i]->look(view);
  }
}

struct Total {
  FlightLog sum;  ///< counts added, times the latest of all flights
  std::size_t complete = 0;
  std::size_t failed = 0;
};

Total total_of(const Flights& flights) {
  Total out;
  const auto latest = [](std::optional<double>& into, const std::optional<double>& from) {
    if (from) into = std::max(into.value_or(0.0), *from);
  };
  for (const auto& flight : flights) {
    const FlightLog& log = flight->log();
    out.sum.meshes += log.meshes;
    out.sum.empties += log.empties;
    out.sum.strips += log.strips;
    out.sum.strip_bytes += log.strip_bytes;
    out.sum.leaves += log.leaves;
    out.sum.bytes += log.bytes;
    out.sum.triangles += log.triangles;
    out.sum.views += log.views;
    out.sum.idles += log.idles;
    out.sum.wanted += log.wanted;
    latest(out.sum.welcome_s, log.welcome_s);
    latest(out.sum.first_chunk_s, log.first_chunk_s);
    latest(out.sum.first_ground_s, log.first_ground_s);
    latest(out.sum.complete_s, log.complete_s);
    out.complete += log.complete_s ? 1U : 0U;
    out.failed += log.error ? 1U : 0U;
    if (log.error && !out.sum.error) out.sum.error = log.error;
  }
  return out;
}

std::string time_text(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.3f} s", *seconds) : std::string("never");
}
std::string time_json(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.4f}", *seconds) : std::string("null");
}

void print_line(const Total& now, const Total& before, double seconds, std::size_t viewers) {
  fmt::print(stderr, "{:6.1f} s  {:7} chunks (+{})  {:8.2f} MB (+{:.2f})  wanted {}  complete {}/{}  failed {}\n",
             seconds, now.sum.chunks(), now.sum.chunks() - before.sum.chunks(),
             static_cast<double>(now.sum.bytes) / 1e6, static_cast<double>(now.sum.bytes - before.sum.bytes) / 1e6,
             now.sum.wanted, now.complete, viewers, now.failed);
}

void print_summary(const Total& total, const FlyOptions& options, double seconds) {
  const FlightLog& sum = total.sum;
  if (options.is_json) {
    fmt::print(
        R"({{"viewers":{},"complete":{},"failed":{},"seconds":{:.3f},"welcome_s":{},"first_chunk_s":{},)"
        R"("first_ground_s":{},"complete_s":{},"chunks":{},"meshes":{},"empties":{},"strips":{},"strip_bytes":{},"leaves":{},"bytes":{},)"
        R"("triangles":{},"views":{},"idles":{},"wanted":{},"error":{}}})"
        "\n",
        options.viewers, total.complete, total.failed, seconds, time_json(sum.welcome_s), time_json(sum.first_chunk_s),
        time_json(sum.first_ground_s), time_json(sum.complete_s), sum.chunks(), sum.meshes, sum.empties, sum.strips,
        sum.strip_bytes, sum.leaves, sum.bytes, sum.triangles, sum.views, sum.idles, sum.wanted,
        sum.error ? json_string(sum.error->message) : "null");
    return;
  }
  fmt::print("viewers         {} ({} complete, {} failed)\n", options.viewers, total.complete, total.failed);
  fmt::print("welcome         {}\nfirst chunk     {}\nfirst ground    {}\ncomplete view   {}\n",
             time_text(sum.welcome_s), time_text(sum.first_chunk_s), time_text(sum.first_ground_s),
             time_text(sum.complete_s));
  fmt::print("chunks          {} ({} with a surface, {} left again)\nbytes           {} ({:.1f} a surface)\n",
             sum.chunks(), sum.meshes, sum.leaves, sum.bytes,
             sum.meshes > 0 ? static_cast<double>(sum.bytes) / static_cast<double>(sum.meshes) : 0.0);
  fmt::print("seam strips     {} ({} bytes)\n", sum.strips, sum.strip_bytes);
  if (options.decodes) fmt::print("triangles       {}\n", sum.triangles);
  if (sum.error) fmt::print("error           {}\n", sum.error->message);
}

/// Flies until the time is up, everything wanted has come, every viewer has failed, or somebody presses Ctrl-C.
double fly_until_done(client::Loop& loop, Flights& flights, const FlyOptions& options, const Path& path) {
  const Clock::time_point began = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  Total before;
  double next_line = 1.0;
  double next_look = 0.0;
  for (;;) {
    const double seconds = elapsed();
    const Total now = total_of(flights);
    const bool is_complete = options.until_complete && now.complete + now.failed == flights.size();
    const bool all_over = std::ranges::all_of(flights, [](const auto& flight) { return flight->is_over(); });
    if (seconds >= options.seconds || is_complete || all_over || is_interrupted()) return seconds;
    if (seconds >= next_line) {
      print_line(now, before, seconds, flights.size());
      before = now;
      next_line += 1.0;
    }
    if (seconds >= next_look) {
      // One that stands still has nothing new to say.
      if (next_look == 0.0 || seconds <= path.duration_s + 0.2) look_from(flights, options, path, seconds);
      next_look = seconds + std::chrono::duration<double>(kTick).count();
    }
    loop.run_for(options.until_complete ? std::chrono::milliseconds(5) : std::chrono::milliseconds(20));
  }
}

}  // namespace

ExitCode fly(const FlyOptions& options) {
  const auto server = reach_server(options.server);
  if (!server) return server.error();
  const auto path = path_of(options, *server);
  if (!path) return kUsage;
  catch_interrupt();

  client::Loop loop;
  Flights flights = take_off(loop, options, *server);
  const double seconds = fly_until_done(loop, flights, options, *path);
  const Total total = total_of(flights);
  for (const auto& flight : flights) flight->close();
  loop.run_for(std::chrono::milliseconds(200));

  print_summary(total, options, seconds);
  if (total.sum.error) fmt::print(stderr, "talus: {}\n", total.sum.error->message);
  return total.failed == 0 && total.complete == flights.size() ? kDone : kIncomplete;
}

}  // namespace talus::cli
