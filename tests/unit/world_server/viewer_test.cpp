#include "server/world/viewer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace talus::server {
namespace {

using protocol::Credit;
using protocol::Held;
using protocol::HeldChunk;
using protocol::ViewMessage;
using protocol::Want;

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 40;
const protocol::WorldShape kShape{32, 1.0, {-100.0, 300.0}};

ViewMessage view_at(double x, std::uint32_t sequence = 1) {
  ViewMessage message{sequence, {}};
  message.view.position = {x, 50.0, 0.0};
  message.view.far_m = 400.0;
  return message;
}

std::vector<ChunkKey> area_of(const ViewMessage& message) {
  std::vector<ChunkKey> area;
  protocol::interest_area(protocol::clamped(message.view, kShape), kShape, area);
  std::sort(area.begin(), area.end());
  return area;
}

/// Requests and delivers everything; the keys in order.
std::vector<ChunkKey> deliver_all(Viewer& viewer) {
  std::vector<ChunkKey> out;
  while (const auto next = viewer.next_request()) {
    EXPECT_EQ(viewer.deliver(next->key, 10), Viewer::Delivery::kSend);
    out.push_back(next->key);
  }
  return out;
}

TEST(Viewer, AsksForExactlyTheInterestAreaMostUrgentFirst) {
  Viewer viewer(kShape, kPlenty);
  ASSERT_TRUE(viewer.on_message(view_at(0)));
  const auto change = viewer.refresh();
  ASSERT_TRUE(change.accepted.has_value());
  EXPECT_EQ(change.accepted->sequence, 1U);
  double last = -1e9;
  std::vector<ChunkKey> asked;
  while (const auto next = viewer.next_request()) {
    EXPECT_GE(next->urgency, last);
    last = next->urgency;
    asked.push_back(next->key);
    viewer.deliver(next->key, 1);
  }
  EXPECT_EQ(change.accepted->chunks, asked.size());
  std::sort(asked.begin(), asked.end());
  EXPECT_EQ(asked, area_of(view_at(0)));
}

TEST(Viewer, AnswersTheLatestViewOnly) {
  Viewer viewer(kShape, kPlenty);
  viewer.on_message(view_at(0, 1));
  viewer.on_message(view_at(5000, 2));
  const auto change = viewer.refresh();
  EXPECT_EQ(change.accepted->sequence, 2U);
  std::vector<ChunkKey> asked = deliver_all(viewer);
  std::sort(asked.begin(), asked.end());
  EXPECT_EQ(asked, area_of(view_at(5000)));
}

TEST(Viewer, LeavesWhatItHoldsAndCancelsWhatIsInFlightWhenTheyAreNoLongerWanted) {
  Viewer viewer(kShape, kPlenty);
  viewer.on_message(view_at(0, 1));
  viewer.refresh();
  const auto held = viewer.next_request();
  const auto flying = viewer.next_request();
  ASSERT_TRUE(held && flying);
  viewer.deliver(held->key, 10);
  viewer.on_message(view_at(100'000, 2));
  const auto change = viewer.refresh();
  EXPECT_EQ(change.leave, std::vector<ChunkKey>{held->key});
  EXPECT_EQ(change.cancelled, std::vector<ChunkKey>{flying->key});
  EXPECT_EQ(viewer.in_flight(), 0U);
  EXPECT_EQ(viewer.deliver(flying->key, 10), Viewer::Delivery::kUnwanted);
}

TEST(Viewer, AgreesWithTheDifferenceOfAreasOnAWalk) {
  Viewer viewer(kShape, kPlenty);
  std::set<ChunkKey> client;
  for (std::uint32_t step = 0; step < 40; ++step) {
    const ViewMessage message = view_at(step * 37.0, step + 1);
    viewer.on_message(message);
    for (const ChunkKey& key : viewer.refresh().leave) EXPECT_EQ(client.erase(key), 1U);
    for (const ChunkKey& key : deliver_all(viewer)) EXPECT_TRUE(client.insert(key).second) << "sent twice";
    const auto area = area_of(message);
    EXPECT_EQ(std::vector<ChunkKey>(client.begin(), client.end()), area);
  }
}

TEST(Viewer, StopsAtTheEndOfItsCreditAndGoesOnWithMore) {
  Viewer viewer(kShape, 25);
  viewer.on_message(view_at(0));
  viewer.refresh();
  const auto a = viewer.next_request();
  const auto b = viewer.next_request();
  const auto c = viewer.next_request();
  EXPECT_EQ(viewer.deliver(a->key, 10), Viewer::Delivery::kSend);
  EXPECT_EQ(viewer.deliver(b->key, 15), Viewer::Delivery::kSend);
  EXPECT_EQ(viewer.deliver(c->key, 1), Viewer::Delivery::kNoCredit);
  viewer.on_message(Credit{1});
  EXPECT_EQ(viewer.deliver(c->key, 1), Viewer::Delivery::kSend);
  EXPECT_EQ(viewer.credit_bytes(), 0U);
}

TEST(Viewer, SaturatesCreditInsteadOfWrapping) {
  Viewer viewer(kShape, kPlenty);
  viewer.on_message(Credit{~std::uint64_t{0}});
  viewer.on_message(Credit{~std::uint64_t{0}});
  EXPECT_GE(viewer.credit_bytes(), kPlenty);
}

TEST(Viewer, IsIdleOnceAfterEveryChangeAndOnlyWhenAllIsDelivered) {
  Viewer viewer(kShape, kPlenty);
  EXPECT_FALSE(viewer.take_idle());
  viewer.on_message(view_at(0, 9));
  EXPECT_FALSE(viewer.take_idle());
  viewer.refresh();
  const auto last = viewer.next_request();
  deliver_all(viewer);
  EXPECT_FALSE(viewer.take_idle()) << "one is in flight";
  viewer.put_back(last->key);
  EXPECT_FALSE(viewer.take_idle()) << "one is wanted";
  deliver_all(viewer);
  const auto idle = viewer.take_idle();
  ASSERT_TRUE(idle);
  EXPECT_EQ(idle->view_sequence, 9U);
  EXPECT_EQ(idle->chunks_sent, area_of(view_at(0)).size());
  EXPECT_FALSE(viewer.take_idle());
}

TEST(Viewer, DoesNotSendWhatTheClientHoldsAlready) {
  const auto area = area_of(view_at(0));
  Viewer viewer(kShape, kPlenty);
  Held held;
  for (std::size_t i = 0; i < area.size(); i += 2) held.chunks.push_back({area[i], 0});
  held.chunks.push_back({area[1], 7});  // of a revision that is not the current one
  held.chunks.push_back({{0, 5000, 0, 0}, 0});
  viewer.on_message(held);
  viewer.on_message(view_at(0));
  EXPECT_EQ(viewer.refresh().leave, (std::vector<ChunkKey>{{0, 5000, 0, 0}}));
  EXPECT_EQ(deliver_all(viewer).size(), area.size() / 2);
}

TEST(Viewer, SendsWhatIsWantedByKeyInTheClientsOrderAndReplacesTheLastWant) {
  Viewer viewer(kShape, kPlenty);
  Want want;
  for (const std::int32_t x : {9, 3, 5}) want.chunks.push_back({{2, x, 0, 0}, 0});
  viewer.on_message(want);
  EXPECT_FALSE(viewer.refresh().accepted) << "there was no view";
  EXPECT_EQ(deliver_all(viewer), (std::vector<ChunkKey>{{2, 9, 0, 0}, {2, 3, 0, 0}, {2, 5, 0, 0}}));
  viewer.on_message(Want{{HeldChunk{{2, 3, 0, 0}, 0}}});
  EXPECT_EQ(viewer.refresh().leave.size(), 2U);
}

TEST(Viewer, HoldsABoundedNumberOfKeysHoweverManyAreClaimed) {
  Viewer viewer(kShape, kPlenty);
  for (std::int32_t batch = 0; batch < 40; ++batch) {
    Held held;
    for (std::int32_t i = 0; i < 2600; ++i) held.chunks.push_back({{0, batch * 2600 + i, 0, 0}, 0});
    viewer.on_message(held);
  }
  EXPECT_LE(viewer.refresh().leave.size(), 40'000U);
}

TEST(Viewer, RefusesMessagesThatAreNotAViewers) {
  Viewer viewer(kShape, kPlenty);
  EXPECT_FALSE(viewer.on_message(protocol::Hello{}));
  EXPECT_FALSE(viewer.on_message(protocol::Idle{}));
}

}  // namespace
}  // namespace talus::server
