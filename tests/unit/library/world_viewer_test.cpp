#include "client_sample/library/world_viewer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "client_sample/library/decode_queue.hpp"
#include "tests/unit/library/scripted_server.hpp"
#include "tests/unit/protocol/sample_mesh.hpp"

namespace talus::client {
namespace {

constexpr std::uint16_t kVersion = 2;  ///< with strips

Bytes surface_of(const ChunkKey& key, unsigned seed) {
  return *protocol::encode_draco(protocol::sample_surface(32, seed), protocol::mesh_lattice(key, 32, 1.0));
}

class WorldViewerTest : public testing::Test {
 protected:
  void open(ViewerOptions options = {}) {
    options.server = server.address();
    options.retry_min = std::chrono::milliseconds(20);
    viewer.emplace(loop, options);
  }
  bool is_greeted() {
    return run_until(loop, [this] { return server.heard_of<protocol::Hello>() == 1; });
  }
  void say_chunk(const ChunkKey& key, const Bytes& payload, std::uint8_t faces = 0) {
    const ChunkKind kind = payload.empty() ? ChunkKind::kAir : ChunkKind::kMesh;
    server.say(protocol::ChunkHead{key, 0, kind, static_cast<std::uint32_t>(payload.size()), faces}, payload);
  }
  /// The connection is lost once `surface` is held, and the next one's hello has come.
  bool comes_back_holding(const ChunkKey& key, const Bytes& surface) {
    say_chunk(key, surface);
    const bool is_held = run_until(loop, [this] { return viewer->held() == 1; });
    server.hang_up();
    const bool is_lost = run_until(loop, [this] { return !viewer->is_connected(); });
    server.accept();
    return is_held && is_lost && is_greeted();
  }
  /// The next event, which must be a T.
  template <typename T>
  T take() {
    std::optional<ViewerEvent> event;
    EXPECT_TRUE(run_until(loop, [&] {
      if (!event) event = viewer->next();
      return event.has_value();
    }));
    if (event && std::holds_alternative<T>(*event)) return std::get<T>(std::move(*event));
    ADD_FAILURE() << "event " << (event ? static_cast<int>(event->index()) : -1);
    return {};
  }

  Loop loop;
  ScriptedServer server{loop};
  std::optional<WorldViewer> viewer;
};

TEST_F(WorldViewerTest, HandsOutWhatHappenedInItsOrder) {
  open();
  const std::uint32_t look = viewer->look({});
  ASSERT_TRUE(is_greeted());
  server.say(welcome({}, kVersion));
  const Bytes surface = surface_of({1, 2, 3, 4}, 7);
  say_chunk({1, 2, 3, 4}, surface, 5);
  say_chunk({0, 9, 9, 9}, {});
  server.say(protocol::Leave{{{0, 9, 9, 9}}});
  server.say(protocol::Idle{1, 2});

  EXPECT_EQ(take<Connected>().info.name, "default");
  const auto chunk = take<ChunkReady>();
  EXPECT_EQ(chunk.key, (ChunkKey{1, 2, 3, 4}));
  EXPECT_EQ(chunk.faces, 5);
  EXPECT_EQ(chunk.step_m, 2.0 / 64);
  EXPECT_EQ(chunk.mesh.triangles(), protocol::sample_surface(32, 7).triangles());
  EXPECT_EQ(take<ChunkReady>().kind, ChunkKind::kAir);
  EXPECT_EQ(take<Forget>().keys, (std::vector<ChunkKey>{{0, 9, 9, 9}}));
  EXPECT_EQ(take<Complete>().look, look);
  EXPECT_EQ(viewer->held(), 1U);
}

TEST_F(WorldViewerTest, ComesBackWithWhatItHolds) {
  open();
  viewer->look({});
  ASSERT_TRUE(is_greeted());
  server.say(welcome({}, kVersion));
  say_chunk({1, 0, 0, 0}, surface_of({1, 0, 0, 0}, 1), 3);
  say_chunk({0, 1, 1, 1}, {});
  server.say(protocol::StripHead{{{1, 0, 0, 0}, ChunkFace::kNy}, 0, 0});
  server.say(protocol::StripHead{{{1, 5, 0, 0}, ChunkFace::kPx}, 0, 0});
  server.say(protocol::Leave{{{0, 1, 1, 1}, {1, 5, 0, 0}}});
  take<Connected>();
  take<ChunkReady>();
  take<ChunkReady>();
  take<StripReady>();
  take<StripReady>();
  take<Forget>();
  protocol::View view;
  view.position = {1, 2, 3};
  const std::uint32_t look = viewer->look(view);
  server.hang_up();
  const auto lost = take<Disconnected>();
  ASSERT_TRUE(lost.retry_in);
  EXPECT_FALSE(viewer->is_connected());
  EXPECT_EQ(viewer->held(), 1U) << "what was handed out stays";

  server.accept();
  ASSERT_TRUE(is_greeted());
  server.say(welcome({}, kVersion));
  ASSERT_TRUE(run_until(loop, [&] { return server.heard_of<protocol::ViewMessage>() == 1; }));
  ASSERT_EQ(server.heard_of<protocol::Held>(), 2U);
  const auto& chunks = std::get<protocol::Held>(server.heard()[1]);
  EXPECT_EQ(chunks.chunks, (std::vector<protocol::HeldChunk>{{{1, 0, 0, 0}, 0}}));
  EXPECT_EQ(chunks.faces, (std::vector<std::uint8_t>{3}));
  EXPECT_EQ(std::get<protocol::Held>(server.heard()[2]).strips,
            (std::vector<StripKey>{{{1, 0, 0, 0}, ChunkFace::kNy}}));
  EXPECT_EQ(std::get<protocol::ViewMessage>(server.heard()[3]).view.position, view.position);
  take<Connected>();
  server.say(protocol::Idle{1, 0});
  EXPECT_EQ(take<Complete>().look, look) << "looks are counted over all connections";
}

TEST_F(WorldViewerTest, ForgetsEverythingOfAWorldThatIsAnotherNow) {
  open();
  ASSERT_TRUE(is_greeted());
  server.say(welcome());
  say_chunk({0, 1, 1, 1}, {});
  take<Connected>();
  take<ChunkReady>();
  server.hang_up();
  take<Disconnected>();
  server.accept();
  ASSERT_TRUE(is_greeted());
  Manifest other;
  other.seed = 99;
  server.say(welcome(other));
  EXPECT_EQ(take<Forget>().keys, (std::vector<ChunkKey>{{0, 1, 1, 1}}));
  EXPECT_EQ(take<Connected>().info.seed, "99");
  EXPECT_EQ(server.heard_of<protocol::Held>(), 0U);
  EXPECT_EQ(viewer->held(), 0U);
}

TEST_F(WorldViewerTest, DoesNotComeBackToAServerThatWillNotHaveIt) {
  open();
  ASSERT_TRUE(is_greeted());
  server.say(protocol::Refused{protocol::RefusedReason::kToken, "no such token", {2}});
  ASSERT_TRUE(run_until(loop, [&] { return server.has_closed_frame(); }));
  server.accept();
  const auto lost = take<Disconnected>();
  EXPECT_EQ(lost.why.code, ErrorCode::kRefused);
  EXPECT_FALSE(lost.retry_in);
  loop.run_for(std::chrono::milliseconds(100));
  EXPECT_EQ(server.heard_of<protocol::Hello>(), 0U);
}

TEST_F(WorldViewerTest, ComesBackToAServerThatIsBusy) {
  open();
  ASSERT_TRUE(is_greeted());
  server.say(protocol::Refused{protocol::RefusedReason::kBusy, "full", {2}});
  ASSERT_TRUE(run_until(loop, [&] { return server.has_closed_frame(); }));
  server.accept();
  EXPECT_TRUE(take<Disconnected>().retry_in);
  EXPECT_TRUE(is_greeted());
}

TEST_F(WorldViewerTest, GivesCreditBackForWhatIsTakenAndNoSooner) {
  ViewerOptions options;
  options.credit_bytes = 1;  // an eighth of it is nothing: every byte goes back at once
  open(options);
  ASSERT_TRUE(is_greeted());
  EXPECT_EQ(std::get<protocol::Hello>(server.heard()[0]).credit_bytes, 1U);
  server.say(welcome());
  say_chunk({0, 1, 1, 1}, {});
  take<Connected>();
  loop.run_for(std::chrono::milliseconds(50));
  EXPECT_EQ(server.heard_of<protocol::Credit>(), 0U);
  take<ChunkReady>();
  EXPECT_TRUE(run_until(loop, [&] { return server.heard_of<protocol::Credit>() == 1; }));
  const auto cost = protocol::encode(protocol::ChunkHead{{0, 1, 1, 1}, 0, ChunkKind::kAir, 0}).size();
  EXPECT_EQ(std::get<protocol::Credit>(server.heard().back()).bytes, cost);
}

TEST_F(WorldViewerTest, OffersANewConnectionNoMoreThanItHasRoomFor) {
  ViewerOptions options;
  options.credit_bytes = 1'000'000;
  open(options);
  ASSERT_TRUE(is_greeted());
  server.say(welcome());
  const Bytes surface = surface_of({0, 0, 0, 0}, 3);
  ASSERT_TRUE(comes_back_holding({0, 0, 0, 0}, surface));
  const auto head = protocol::encode(
      protocol::ChunkHead{{0, 0, 0, 0}, 0, ChunkKind::kMesh, static_cast<std::uint32_t>(surface.size())});
  EXPECT_EQ(std::get<protocol::Hello>(server.heard()[0]).credit_bytes, 1'000'000 - head.size() - surface.size());
}

TEST_F(WorldViewerTest, GivesBackAfterAReconnectWhatWasTakenBeforeTheWelcome) {
  ViewerOptions options;
  options.credit_bytes = 1000;  // less than the surface: the new connection begins without any credit
  open(options);
  ASSERT_TRUE(is_greeted());
  server.say(welcome());
  const Bytes surface = surface_of({0, 0, 0, 0}, 3);
  ASSERT_GT(surface.size(), 1000U);
  ASSERT_TRUE(comes_back_holding({0, 0, 0, 0}, surface));
  EXPECT_EQ(std::get<protocol::Hello>(server.heard()[0]).credit_bytes, 0U);
  take<Connected>();
  take<ChunkReady>();
  take<Disconnected>();
  server.say(welcome());
  ASSERT_TRUE(run_until(loop, [&] { return server.heard_of<protocol::Credit>() == 1; }))
      << "nobody would ever send anything again";
  const auto head = protocol::encode(
      protocol::ChunkHead{{0, 0, 0, 0}, 0, ChunkKind::kMesh, static_cast<std::uint32_t>(surface.size())});
  EXPECT_EQ(std::get<protocol::Credit>(server.heard().back()).bytes, head.size() + surface.size());
}

TEST_F(WorldViewerTest, SaysThatItIsClosedBetweenTwoAttemptsAsWell) {
  open();
  ASSERT_TRUE(is_greeted());
  server.hang_up();
  EXPECT_TRUE(take<Disconnected>().retry_in);
  viewer->close();
  EXPECT_FALSE(take<Disconnected>().retry_in);
  viewer->close();
  EXPECT_FALSE(viewer->next()) << "once";
}

TEST_F(WorldViewerTest, SaysWhatTheServerCannotMakeAndDoesNotHoldIt) {
  open();
  ASSERT_TRUE(is_greeted());
  server.say(welcome({}, 3));
  server.say(protocol::Failed{{0, 1, 1, 1}});
  server.say(protocol::Failed{{1, 0, 0, 0}, ChunkFace::kNy});
  take<Connected>();
  const auto chunk = take<Unmade>();
  EXPECT_EQ(chunk.key, (ChunkKey{0, 1, 1, 1}));
  EXPECT_FALSE(chunk.face);
  EXPECT_EQ(take<Unmade>().face, ChunkFace::kNy);
  EXPECT_EQ(viewer->held(), 0U);
}

TEST_F(WorldViewerTest, EndsWithTheFirstSurfaceThatIsNone) {
  open();
  ASSERT_TRUE(is_greeted());
  server.say(welcome());
  say_chunk({0, 0, 0, 0}, Bytes(100, std::byte{7}));
  say_chunk({0, 1, 0, 0}, surface_of({0, 1, 0, 0}, 1));
  ASSERT_TRUE(run_until(loop, [&] { return viewer->held() == 2; }));
  take<Connected>();
  const auto lost = take<Disconnected>();
  EXPECT_EQ(lost.why.code, ErrorCode::kProtocol);
  EXPECT_FALSE(lost.retry_in);
  EXPECT_FALSE(viewer->decode_one(std::chrono::milliseconds(0))) << "what came behind it is dropped";
}

TEST_F(WorldViewerTest, KeepsTheOrderHoweverManyThreadsDecode) {
  ViewerOptions options;
  options.decodes_in_next = false;
  open(options);
  ASSERT_TRUE(is_greeted());
  server.say(welcome());
  take<Connected>();
  constexpr int kChunks = 40;
  const Bytes surface = surface_of({0, 0, 0, 0}, 5);
  for (int i = 0; i < kChunks; ++i) say_chunk({0, i, 0, 0}, i % 4 == 0 ? Bytes{} : surface);
  ASSERT_TRUE(run_until(loop, [&] { return viewer->held() == kChunks; }));
  EXPECT_TRUE(viewer->next()) << "air has nothing to decode";
  EXPECT_FALSE(viewer->next()) << "nobody decodes yet";

  std::vector<std::jthread> decoders;
  for (int i = 0; i < 3; ++i) {
    decoders.emplace_back([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) viewer->decode_one(std::chrono::milliseconds(20));
    });
  }
  for (int i = 1; i < kChunks; ++i) {
    const auto chunk = take<ChunkReady>();
    ASSERT_EQ(chunk.key.x, i);
    EXPECT_EQ(chunk.mesh.triangles() > 0, i % 4 != 0);
  }
}

TEST(DecodeQueue, WakesWhoWaitsWhenItStops) {
  DecodeQueue queue;
  bool got_one = true;
  {
    const std::jthread waiting([&] { got_one = queue.decode_one(std::chrono::hours(1)); });
    queue.stop();
  }
  EXPECT_FALSE(got_one);
  EXPECT_FALSE(queue.decode_one(std::chrono::hours(1)));
}

}  // namespace
}  // namespace talus::client
