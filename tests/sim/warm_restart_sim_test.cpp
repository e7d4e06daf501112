// What a server has made once, the next one serves from its disk.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/sim/running_server.hpp"
#include "tests/sim/stream_peer.hpp"
#include "tests/support/scratch_folder.hpp"

namespace talus::server {
namespace {

namespace fs = std::filesystem;

class WarmRestart : public testing::Test {
 protected:
  WarmRestart() { settings.disk_cache = folder.path().string(); }

  /// Every chunk message of one view, as it came; the view must become complete, however busy the machine.
  static std::map<ChunkKey, std::string> view_of(RunningServer& server) {
    StreamPeer stream(server->http_address());
    EXPECT_TRUE(stream.open(std::uint64_t{1} << 40));
    stream.look_from(0, 700);
    std::map<ChunkKey, std::string> out;
    bool is_complete = false;
    constexpr int kPing = 9;
    constexpr int kPong = 10;
    while (auto frame = stream.next_frame()) {
      if (frame->opcode == kPing) {
        stream.send_bytes(frame->bytes, kPong);
        continue;
      }
      const auto message = protocol::decode(std::as_bytes(std::span(frame->bytes)));
      is_complete = message && std::holds_alternative<protocol::Idle>(message->message);
      if (!message || is_complete) break;
      if (const auto* chunk = std::get_if<protocol::ChunkHead>(&message->message)) out[chunk->key] = frame->bytes;
    }
    EXPECT_TRUE(is_complete) << "after " << out.size() << " chunks";
    return out;
  }

  const test::ScratchFolder folder;
  Settings settings = quiet_settings();
};

TEST_F(WarmRestart, ServesAKnownViewWithoutMakingAChunk) {
  std::map<ChunkKey, std::string> cold;
  {
    RunningServer server(settings);
    cold = view_of(server);
    EXPECT_GT(server.count(Count::kChunkBuilt), 100U);
  }
  ASSERT_GT(cold.size(), 100U);
  RunningServer server(settings);
  EXPECT_TRUE(view_of(server) == cold) << "the same messages, byte for byte";
  EXPECT_EQ(server.count(Count::kChunkBuilt), 0U);
  EXPECT_GT(server.count(Count::kChunkStored), 100U);
}

TEST_F(WarmRestart, MakesAnewWhatTheDiskHasLost) {
  std::map<ChunkKey, std::string> cold;
  {
    RunningServer server(settings);
    cold = view_of(server);
    fs::remove_all(folder.path());
  }
  RunningServer server(settings);
  EXPECT_TRUE(view_of(server) == cold);
  EXPECT_GT(server.count(Count::kChunkBuilt), 100U);
}

TEST_F(WarmRestart, EndsAtTheStartWhenTheFolderCannotBeUsed) {
  RunningServer first(settings);
  const auto second = Server::start(settings);
  ASSERT_FALSE(second.has_value());
  EXPECT_NE(second.error().find("another server"), std::string::npos) << second.error();
}

}  // namespace
}  // namespace talus::server
