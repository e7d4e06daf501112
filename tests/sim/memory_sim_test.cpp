// What one connection may cost: thousands that say nothing, and those that never read.
#include <gtest/gtest.h>

#include <linux/sock_diag.h>
#include <malloc.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "tests/sim/running_server.hpp"
#include "tests/sim/stream_peer.hpp"

namespace talus::server {
namespace {

using Carrier = StreamPeer::Carrier;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kHasOwnMalloc = false;
#else
constexpr bool kHasOwnMalloc = true;
#endif

constexpr std::uint64_t kReaderCredit = 64 << 20;

class MemorySim : public testing::TestWithParam<Carrier> {
 protected:
  static Settings settings() {
    Settings out = quiet_settings();
    out.limits.connections_per_address = 1000;
    return out;
  }
  static std::string_view door(RunningServer& server) {
    return GetParam() == Carrier::kTcp ? server->tcp_address() : server->http_address();
  }
};

INSTANTIATE_TEST_SUITE_P(Carriers, MemorySim, testing::Values(Carrier::kWebSocket, Carrier::kTcp),
                         [](const auto& of) { return of.param == Carrier::kTcp ? "Tcp" : "WebSocket"; });

TEST_P(MemorySim, KeepsAnIdleStreamInSixteenKiBAtMost) {
  if (!kHasOwnMalloc) GTEST_SKIP() << "this build's allocator does not say what is allocated";
  constexpr std::size_t kPeers = 200;
  constexpr std::size_t kBytesMax = 16 * 1024;
  RunningServer server(settings());
  StreamPeer first(door(server), GetParam());
  ASSERT_TRUE(first.open(kReaderCredit));
  std::vector<std::unique_ptr<StreamPeer>> peers;
  peers.reserve(kPeers);
  const std::size_t before = ::mallinfo2().uordblks;
  for (std::size_t i = 0; i < kPeers; ++i) {
    peers.push_back(std::make_unique<StreamPeer>(door(server), GetParam()));
    ASSERT_TRUE(peers.back()->open(kReaderCredit));
    // A long message now and then leaves nothing behind.
    protocol::Want want;
    want.chunks.assign(1000, {{0, 0, 10'000, 0}, 0});
    peers.back()->send(want);
    peers.back()->send(protocol::Want{});
    peers.back()->send(protocol::Ping{7});
    ASSERT_TRUE(peers.back()->next_of<protocol::Pong>().has_value());
  }
  // The peers of this test are counted as well: about 1 KiB each.
  const auto each = [&] { return (::mallinfo2().uordblks - before) / kPeers; };
  EXPECT_TRUE(eventually([&] { return each() <= kBytesMax; })) << each() << " bytes each";
}

/// What the kernel holds for the server's end of the connection whose other end is at `port`: bytes it was given and
/// has not got rid of. The server is in this process, so its sockets are among our descriptors.
std::size_t held_for_peer_at(in_port_t port) {
  constexpr int kDescriptorsMax = 1024;
  std::size_t held = 0;
  for (int descriptor = 0; descriptor < kDescriptorsMax; ++descriptor) {
    sockaddr_in peer{};
    socklen_t length = sizeof peer;
    if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&peer), &length) != 0 || peer.sin_port != port) continue;
    std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
    length = sizeof memory;
    if (::getsockopt(descriptor, SOL_SOCKET, SO_MEMINFO, memory.data(), &length) != 0) continue;
    held = memory[SK_MEMINFO_WMEM_QUEUED] + memory[SK_MEMINFO_FWD_ALLOC] + memory[SK_MEMINFO_RMEM_ALLOC];
  }
  return held;
}

TEST_P(MemorySim, PinsLittleOfTheKernelsMemoryForAReaderThatTakesNothing) {
  constexpr std::size_t kBytesMax = 512 * 1024;
  RunningServer server(settings());
  StreamPeer stream(door(server), GetParam());
  ASSERT_TRUE(stream.open(kReaderCredit));
  stream.look_from(0, 6000);
  // The most it ever is, until the server cuts who takes nothing.
  std::size_t held = 0;
  EXPECT_TRUE(eventually([&] {
    held = std::max(held, held_for_peer_at(stream.peer.port()));
    return server.count(Count::kWriteStalled) + server.count(Count::kReadTooSlow) != 0;
  }));
  EXPECT_GT(held, 0U);
  EXPECT_LT(held, kBytesMax);
}

}  // namespace
}  // namespace talus::server
