// What connections cost that do nothing, or worse than nothing: `talus_connections PROGRAM [IDLE] [STALLED]` starts the
// talusd PROGRAM, holds IDLE welcomed WebSocket streams (10,000), then lets STALLED viewers (500) ask for a view and
// never read it, while one ordinary client goes on. All on loopback; ends by itself in about a minute.
//
// Peers come from addresses 127.0.0.1 onwards, as many from each as a server allows by default.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/connections/served.hpp"
#include "tests/sim/stream_peer.hpp"

namespace talus::bench {

namespace {

using server::StreamPeer;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kPeersPerAddress = 60;
constexpr double kMiB = 1024.0 * 1024.0;
constexpr std::uint64_t kCreditBytes = 64 << 20;
constexpr double kViewM = 2000;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void pause_ms(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

/// Where the i-th peer comes from, in addresses behind 127.0.0.1.
std::uint32_t host_of(std::size_t i) {
  return static_cast<std::uint32_t>(1 + i / kPeersPerAddress);
}

void measure_idle(const Served& server, std::size_t count) {
  const std::size_t resident = server.resident_bytes();
  const std::size_t tcp = machine_tcp_bytes();
  std::vector<StreamPeer> peers;
  peers.reserve(count);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < count; ++i) {
    peers.emplace_back(server.http(), StreamPeer::Carrier::kWebSocket, 0, host_of(i));
    if (!peers.back().open(kCreditBytes)) ++refused;
  }
  pause_ms(1000);
  const auto per_peer = [&](std::size_t bytes) {
    return static_cast<double>(bytes) / 1024 / static_cast<double>(count);
  };
  std::printf("%zu idle WebSocket streams, %zu refused\n", count, refused);
  std::printf("  server's memory      %8.2f KiB each (%.1f MiB before)\n", per_peer(server.resident_bytes() - resident),
              static_cast<double>(resident) / kMiB);
  std::printf("  kernel, server's end %8.2f KiB each\n", per_peer(server.socket_bytes()));
  std::printf("  kernel, both ends    %8.2f KiB each\n", per_peer(std::max(machine_tcp_bytes(), tcp) - tcp));
}

/// Milliseconds of the slowest of every hundred requests of somebody who does nothing wrong, for `s` seconds.
double ordinary_p99_ms(server::Peer& peer, const std::string& target, double s) {
  std::vector<double> took_ms;
  for (const auto start = Clock::now(); seconds_since(start) < s;) {
    const auto asked = Clock::now();
    peer.send(server::get_request(target));
    if (read_response(peer).status != 200) return -1;
    took_ms.push_back(seconds_since(asked) * 1000);
    pause_ms(2);
  }
  std::sort(took_ms.begin(), took_ms.end());
  return took_ms[took_ms.size() * 99 / 100];
}

void measure_stalled(const Served& server, std::size_t count) {
  StreamPeer first(server.http());
  first.peer.wait_at_most(60);
  if (!first.open(kCreditBytes)) return;
  first.look_from(0, kViewM);
  if (!first.next_of<protocol::Idle>()) return;  // from here on every chunk of the view is in memory
  server::Peer ordinary(server.http());
  const std::string target = "/v1/worlds/default/columns/4/0/0.height";
  ordinary.send(server::get_request(target));
  read_response(ordinary);
  const double before_ms = ordinary_p99_ms(ordinary, target, 3);

  const std::string cut = "talus_sessions_ended_total{reason=\"too_slow\"}";
  const double cut_before = server.metric(cut);
  const std::size_t resident = server.resident_bytes();
  const std::size_t held = server.socket_bytes();
  std::vector<StreamPeer> peers;
  peers.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    peers.emplace_back(server.http(), StreamPeer::Carrier::kWebSocket, 0, host_of(i));
    peers.back().open(kCreditBytes);
  }
  const auto start = Clock::now();
  for (StreamPeer& peer : peers) peer.look_from(0, kViewM);
  double user_peak = 0;
  double kernel_peak = 0;
  double during_ms = 0;
  double filled_s = 0;  // when the kernel last held more for them than before
  while (server.metric(cut) - cut_before < static_cast<double>(count) && seconds_since(start) < 60) {
    const double each = static_cast<double>(count) * kMiB;
    user_peak = std::max(user_peak, static_cast<double>(server.resident_bytes() - resident) / each);
    const double kernel = static_cast<double>(server.socket_bytes() - held) / each;
    if (kernel > kernel_peak) filled_s = seconds_since(start);
    kernel_peak = std::max(kernel_peak, kernel);
    during_ms = std::max(during_ms, ordinary_p99_ms(ordinary, target, 1));
  }
  std::printf("%zu stalled readers of a %.0f m view\n", count, kViewM);
  std::printf("  server's memory      %8.3f MiB each at most\n", user_peak);
  std::printf("  kernel, server's end %8.3f MiB each at most\n", kernel_peak);
  const double cut_s = seconds_since(start);
  std::printf(
      "  cut                  %8.0f of them within %.1f s of asking, %.1f s after the last byte was taken for any\n",
      server.metric(cut) - cut_before, cut_s, cut_s - filled_s);
  std::printf("  an ordinary client   %8.2f ms p99 before, %.2f ms in the worst second\n", before_ms, during_ms);
}

int run(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: talus_connections PROGRAM [IDLE] [STALLED]\n");
    return 2;
  }
  const auto number = [&](int i, std::size_t otherwise) {
    return argc > i ? static_cast<std::size_t>(std::strtoull(argv[i], nullptr, 10)) : otherwise;
  };
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
  measure_idle(Served(argv[1], {"--ping-s", "600", "--gone-s", "1200"}), number(2, 10'000));
  measure_stalled(Served(argv[1], {}), number(3, 500));
  return 0;
}

}  // namespace

}  // namespace talus::bench

int main(int argc, char** argv) {
  try {
    return talus::bench::run(argc, argv);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "talus_connections: %s\n", fault.what());
    return 1;
  }
}
