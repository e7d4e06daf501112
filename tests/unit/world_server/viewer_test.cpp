#include "server/world/viewer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>

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
    EXPECT_EQ(viewer.deliver(next->piece, 10), Viewer::Delivery::kSend);
    out.push_back(next->piece.key);
  }
  return out;
}

TEST(Viewer, AsksForExactlyTheInterestAreaMostUrgentFirst) {
  Viewer viewer(kShape, kPlenty, true);
  ASSERT_TRUE(viewer.on_message(view_at(0)));
  const auto change = viewer.refresh();
  ASSERT_TRUE(change.accepted.has_value());
  EXPECT_EQ(change.accepted->sequence, 1U);
  double last = -1e9;
  std::vector<ChunkKey> asked;
  while (const auto next = viewer.next_request()) {
    EXPECT_GE(next->urgency, last);
    last = next->urgency;
    asked.push_back(next->piece.key);
    viewer.deliver(next->piece, 1);
  }
  EXPECT_EQ(change.accepted->chunks, asked.size());
  std::sort(asked.begin(), asked.end());
  EXPECT_EQ(asked, area_of(view_at(0)));
}

TEST(Viewer, AnswersTheLatestViewOnly) {
  Viewer viewer(kShape, kPlenty, true);
  viewer.on_message(view_at(0, 1));
  viewer.on_message(view_at(5000, 2));
  const auto change = viewer.refresh();
  EXPECT_EQ(change.accepted->sequence, 2U);
  std::vector<ChunkKey> asked = deliver_all(viewer);
  std::sort(asked.begin(), asked.end());
  EXPECT_EQ(asked, area_of(view_at(5000)));
}

TEST(Viewer, LeavesWhatItHoldsAndCancelsWhatIsInFlightWhenTheyAreNoLongerWanted) {
  Viewer viewer(kShape, kPlenty, true);
  viewer.on_message(view_at(0, 1));
  viewer.refresh();
  const auto held = viewer.next_request();
  const auto flying = viewer.next_request();
  ASSERT_TRUE(held && flying);
  viewer.deliver(held->piece, 10);
  viewer.on_message(view_at(100'000, 2));
  const auto change = viewer.refresh();
  EXPECT_EQ(change.leave, std::vector<ChunkKey>{held->piece.key});
  EXPECT_EQ(change.cancelled, std::vector<Piece>{flying->piece});
  EXPECT_EQ(viewer.in_flight(), 0U);
  EXPECT_EQ(viewer.deliver(flying->piece, 10), Viewer::Delivery::kUnwanted);
}

TEST(Viewer, AgreesWithTheDifferenceOfAreasOnAWalk) {
  Viewer viewer(kShape, kPlenty, true);
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
  Viewer viewer(kShape, 25, true);
  viewer.on_message(view_at(0));
  viewer.refresh();
  const auto a = viewer.next_request();
  const auto b = viewer.next_request();
  const auto c = viewer.next_request();
  EXPECT_EQ(viewer.deliver(a->piece, 10), Viewer::Delivery::kSend);
  EXPECT_EQ(viewer.deliver(b->piece, 15), Viewer::Delivery::kSend);
  EXPECT_EQ(viewer.deliver(c->piece, 1), Viewer::Delivery::kNoCredit);
  viewer.on_message(Credit{1});
  EXPECT_EQ(viewer.deliver(c->piece, 1), Viewer::Delivery::kSend);
  EXPECT_EQ(viewer.credit_bytes(), 0U);
}

TEST(Viewer, SaturatesCreditInsteadOfWrapping) {
  Viewer viewer(kShape, kPlenty, true);
  viewer.on_message(Credit{~std::uint64_t{0}});
  viewer.on_message(Credit{~std::uint64_t{0}});
  EXPECT_GE(viewer.credit_bytes(), kPlenty);
}

TEST(Viewer, IsIdleOnceAfterEveryChangeAndOnlyWhenAllIsDelivered) {
  Viewer viewer(kShape, kPlenty, true);
  EXPECT_FALSE(viewer.take_idle());
  viewer.on_message(view_at(0, 9));
  EXPECT_FALSE(viewer.take_idle());
  viewer.refresh();
  const auto last = viewer.next_request();
  deliver_all(viewer);
  EXPECT_FALSE(viewer.take_idle()) << "one is in flight";
  viewer.put_back(last->piece);
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
  Viewer viewer(kShape, kPlenty, true);
  Held held;
  for (std::size_t i = 0; i < area.size(); i += 2) held.chunks.push_back({area[i], 0});
  held.chunks.push_back({area[1], 7});  // of a revision that is not the current one
  held.chunks.push_back({{0, 5000, 0, 0}, 0});
  held.faces.resize(held.chunks.size());
  viewer.on_message(held);
  viewer.on_message(view_at(0));
  EXPECT_EQ(viewer.refresh().leave, (std::vector<ChunkKey>{{0, 5000, 0, 0}}));
  EXPECT_EQ(deliver_all(viewer).size(), area.size() / 2);
}

TEST(Viewer, SendsWhatIsWantedByKeyInTheClientsOrderAndReplacesTheLastWant) {
  Viewer viewer(kShape, kPlenty, true);
  Want want;
  for (const std::int32_t x : {9, 3, 5}) want.chunks.push_back({{2, x, 0, 0}, 0});
  viewer.on_message(want);
  EXPECT_FALSE(viewer.refresh().accepted) << "there was no view";
  EXPECT_EQ(deliver_all(viewer), (std::vector<ChunkKey>{{2, 9, 0, 0}, {2, 3, 0, 0}, {2, 5, 0, 0}}));
  viewer.on_message(Want{{HeldChunk{{2, 3, 0, 0}, 0}}});
  EXPECT_EQ(viewer.refresh().leave.size(), 2U);
}

TEST(Viewer, HoldsABoundedNumberOfKeysHoweverManyAreClaimed) {
  Viewer viewer(kShape, kPlenty, true);
  for (std::int32_t batch = 0; batch < 40; ++batch) {
    Held held;
    for (std::int32_t i = 0; i < 2600; ++i) held.chunks.push_back({{0, batch * 2600 + i, 0, 0}, 0});
    viewer.on_message(held);
  }
  EXPECT_LE(viewer.refresh().leave.size(), 40'000U);
}

/// A coarse chunk and, across its +x face, the four finer ones that touch it.
const ChunkKey kCoarse{1, 0, 0, 0};
const std::array<ChunkKey, 4> kFiner = finer_across(kCoarse, ChunkFace::kPx);
const Piece kStrip{kCoarse, ChunkFace::kPx};

Want want_of(std::span<const ChunkKey> keys, std::vector<StripKey> strips = {}) {
  Want out;
  for (const ChunkKey& key : keys) out.chunks.push_back({key, 0});
  out.strips = std::move(strips);
  return out;
}

/// Requests and delivers everything, every chunk reaching the faces `faces`; what was sent.
std::vector<Piece> deliver_all_reaching(Viewer& viewer, unsigned faces) {
  std::vector<Piece> out;
  while (const auto next = viewer.next_request()) {
    EXPECT_EQ(viewer.deliver(next->piece, 10, next->piece.face ? 0 : faces), Viewer::Delivery::kSend);
    out.push_back(next->piece);
  }
  return out;
}

TEST(Viewer, SendsAStripWhereTheSurfaceOfAFinerChunkReachesACoarserOne) {
  for (const unsigned faces : {bit_of(ChunkFace::kNx), bit_of(ChunkFace::kPx) | bit_of(ChunkFace::kNy)}) {
    Viewer viewer(kShape, kPlenty, true);
    viewer.on_message(want_of(std::vector<ChunkKey>{kCoarse, kFiner[0], kFiner[1]}));
    viewer.refresh();
    const std::vector<Piece> sent = deliver_all_reaching(viewer, faces);
    const bool reaches = (faces & bit_of(ChunkFace::kNx)) != 0;
    EXPECT_EQ(std::ranges::count(sent, kStrip), reaches ? 1 : 0);
    EXPECT_EQ(sent.size(), reaches ? 4U : 3U) << "no strip twice, and no other";
    EXPECT_TRUE(viewer.take_idle());
  }
}

TEST(Viewer, SendsTheStripAloneWhenANeighbourBecomesFinerOrACoarserOneComes) {
  Viewer viewer(kShape, kPlenty, true);
  viewer.on_message(want_of(std::array{kFiner[2]}));
  viewer.refresh();
  EXPECT_EQ(deliver_all_reaching(viewer, 0x3F).size(), 1U);
  viewer.on_message(want_of(std::array{kFiner[2], kCoarse}));
  viewer.refresh();
  EXPECT_EQ(deliver_all_reaching(viewer, 0).size(), 2U) << "the coarse chunk and its strip";
  viewer.on_message(want_of(std::array{kCoarse}));
  EXPECT_EQ(viewer.refresh().leave, std::vector<ChunkKey>{kFiner[2]});
  viewer.on_message(want_of(std::array{kCoarse, kFiner[3]}));
  viewer.refresh();
  EXPECT_EQ(deliver_all_reaching(viewer, 0x3F), (std::vector<Piece>{{kFiner[3], {}}}))
      << "the strip is held with its chunk";
}

TEST(Viewer, ForgetsStripsWithTheirChunkAndThoseInTheMakingWithTheNeed) {
  Viewer viewer(kShape, kPlenty, true);
  const std::array both{kFiner[0], kCoarse};
  viewer.on_message(want_of(both));
  viewer.refresh();
  deliver_all_reaching(viewer, 0x3F);
  viewer.on_message(want_of(std::array{kFiner[0]}));
  EXPECT_EQ(viewer.refresh().leave, std::vector<ChunkKey>{kCoarse});
  viewer.on_message(want_of(both));
  viewer.refresh();
  const auto first = viewer.next_request();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->piece, kStrip) << "ahead of the chunk, which is as near";
  viewer.on_message(want_of(std::array{kCoarse}));
  EXPECT_EQ(viewer.refresh().cancelled, std::vector<Piece>{kStrip});
}

TEST(Viewer, SendsStripsThatAreWantedByNameForChunksNobodyWants) {
  Viewer viewer(kShape, kPlenty, true);
  viewer.on_message(want_of({}, {{kCoarse, ChunkFace::kPx}}));
  viewer.refresh();
  EXPECT_EQ(deliver_all_reaching(viewer, 0), std::vector<Piece>{kStrip});
  viewer.on_message(want_of({}, {{kCoarse, ChunkFace::kPx}}));
  EXPECT_TRUE(viewer.refresh().leave.empty());
  EXPECT_TRUE(deliver_all_reaching(viewer, 0).empty()) << "once";
}

TEST(Viewer, SendsAStripAgainWhenTheChunkItWasWantedByNameForBecomesWanted) {
  // The client drew the coarse chunk a while longer, got the strip it lacked, and let go of both; it says so only when
  // its view asks for the chunk anew already.
  Viewer viewer(kShape, kPlenty, true);
  const std::vector<StripKey> name{{kCoarse, ChunkFace::kPx}};
  viewer.on_message(want_of(kFiner));
  viewer.refresh();
  deliver_all_reaching(viewer, 0x3F);
  viewer.on_message(want_of(kFiner, name));
  viewer.refresh();
  EXPECT_EQ(deliver_all_reaching(viewer, 0), std::vector<Piece>{kStrip});
  std::vector<ChunkKey> both(kFiner.begin(), kFiner.end());
  both.push_back(kCoarse);
  viewer.on_message(want_of(both, name));
  viewer.refresh();
  EXPECT_EQ(deliver_all_reaching(viewer, 0), (std::vector<Piece>{kStrip, {kCoarse, {}}}));
  viewer.on_message(want_of(both));
  viewer.refresh();
  EXPECT_TRUE(deliver_all_reaching(viewer, 0).empty()) << "held with its chunk";
  EXPECT_TRUE(viewer.take_idle());

  // The same, but nothing needs the strip at the moment when the chunk comes back.
  viewer.on_message(want_of(kFiner, name));
  viewer.refresh();
  EXPECT_TRUE(deliver_all_reaching(viewer, 0).empty());
  viewer.on_message(want_of(std::array{kCoarse}));
  viewer.refresh();
  EXPECT_EQ(deliver_all_reaching(viewer, 0), (std::vector<Piece>{{kCoarse, {}}}));
  viewer.on_message(want_of(both));
  viewer.refresh();
  EXPECT_EQ(std::ranges::count(deliver_all_reaching(viewer, 0x3F), kStrip), 1);
}

TEST(Viewer, DoesNotSendStripsThatAreHeldOrThatTheClientCannotTake) {
  Viewer resuming(kShape, kPlenty, true);
  resuming.on_message(Held{{{kCoarse, 0}, {kFiner[0], 0}}, {0, 0x3F}, {{kCoarse, ChunkFace::kPx}}});
  resuming.on_message(want_of(std::array{kCoarse, kFiner[0]}));
  resuming.refresh();
  EXPECT_FALSE(resuming.next_request());
  Viewer unsure(kShape, kPlenty, true);
  unsure.on_message(Held{{{kCoarse, 0}, {kFiner[0], 0}}});
  unsure.on_message(want_of(std::array{kCoarse, kFiner[0]}));
  unsure.refresh();
  EXPECT_EQ(deliver_all_reaching(unsure, 0), std::vector<Piece>{kStrip}) << "its faces are not known";
  Viewer old(kShape, kPlenty, false);
  old.on_message(want_of(std::array{kCoarse, kFiner[0]}));
  old.refresh();
  EXPECT_EQ(deliver_all_reaching(old, 0x3F).size(), 2U);
}

TEST(Viewer, RefusesMessagesThatAreNotAViewers) {
  Viewer viewer(kShape, kPlenty, true);
  EXPECT_FALSE(viewer.on_message(protocol::Hello{}));
  EXPECT_FALSE(viewer.on_message(protocol::Idle{}));
}

TEST(Viewer, SeesNoFurtherThanItsHostAllowsAndSaysSo) {
  Viewer viewer(kShape, kPlenty, true, 200.0);
  ASSERT_TRUE(viewer.on_message(view_at(0)));
  const auto cut_short = viewer.refresh();
  ASSERT_TRUE(cut_short.accepted);
  EXPECT_EQ(cut_short.accepted->view.far_m, 200.0);
  EXPECT_TRUE(cut_short.is_cut_short);
  ViewMessage nearer = view_at(0, 2);
  nearer.view.far_m = 200.0;
  EXPECT_EQ(cut_short.accepted->chunks, area_of(nearer).size());
  ASSERT_TRUE(viewer.on_message(nearer));
  EXPECT_FALSE(viewer.refresh().is_cut_short);
}

}  // namespace
}  // namespace talus::server
