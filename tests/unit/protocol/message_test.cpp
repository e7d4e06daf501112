#include "protocol/message.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "protocol/limits.hpp"

namespace talus::protocol {
namespace {

std::vector<Message> one_of_each() {
  View view;
  view.position = {1.0e9, -2.5, 3.0};
  view.velocity = {1, 2, 3};
  view.lod_bias = 0.5;
  View accepted;
  accepted.position = {4, 5, 6};
  accepted.near_m = 112;
  return {Hello{1, 3, "default", "secret", {"drc", "glb"}, 1'000'000, "a client"},
          Welcome{1, "session-7", std::string(64, 'a'), "drc", R"({"name":"default"})"},
          Refused{RefusedReason::kWorld, "no such world", {1, 2}},
          ViewMessage{9, view},
          ViewAccepted{9, accepted, 3000},
          Held{{{{0, 1, 2, 3}, 4}, {{kLodMax, kChunkLimit, -kChunkLimit, 0}, 5}}},
          Held{{{{0, 1, 2, 3}, 4}}, {0x15}, {{{1, 0, 1, 1}, ChunkFace::kNz}}},
          Want{{{{8, -1, -1, -1}, 0}}},
          Want{{}, {{{8, -1, -1, -1}, ChunkFace::kPx}, {{1, 2, 3, 4}, ChunkFace::kNy}}},
          ChunkHead{{2, -3, 4, -5}, 6, ChunkKind::kMesh, 11, 0x2A},
          ChunkHead{{2, -3, 4, -5}, 6, ChunkKind::kAir, 0},
          Leave{{{0, 0, 0, 0}, {1, 1, 1, 1}}},
          Idle{9, 12345},
          Credit{std::numeric_limits<std::uint64_t>::max()},
          Ping{77},
          Pong{77},
          Bye{ByeReason::kDraining, "see you"},
          StripHead{{{2, -3, 4, -5}, ChunkFace::kPy}, 6, 7},
          StripHead{{{2, -3, 4, -5}, ChunkFace::kPx}, 0, 0},
          Failed{{2, -3, 4, -5}},
          Failed{{2, -3, 4, -5}, ChunkFace::kPx}};
}

/// A whole message: the head, and behind a chunk as many payload bytes as it declares.
std::vector<std::byte> whole(const Message& message) {
  std::vector<std::byte> bytes = encode(message);
  if (const auto* chunk = std::get_if<ChunkHead>(&message)) bytes.resize(bytes.size() + chunk->payload_bytes);
  if (const auto* strip = std::get_if<StripHead>(&message)) bytes.resize(bytes.size() + strip->payload_bytes);
  return bytes;
}

TEST(Message, OfEveryTypeComesBackAsItWent) {
  for (const Message& message : one_of_each()) {
    const std::vector<std::byte> bytes = whole(message);
    const auto decoded = decode(bytes);
    ASSERT_TRUE(decoded) << name_of(message) << ": " << describe(decoded.error());
    EXPECT_EQ(name_of(decoded->message), name_of(message));
    // Encoding is a function of the value, so equal bytes are equal values.
    EXPECT_EQ(encode(decoded->message), encode(message)) << name_of(message);
  }
}

TEST(Message, KeepsItsFields) {
  const auto hello = decode(encode(Hello{1, 3, "default", "secret", {"drc", "glb"}, 42, "me"}));
  const auto& h = std::get<Hello>(hello->message);
  EXPECT_EQ(h.version_high, 3);
  EXPECT_EQ(h.token, "secret");
  EXPECT_EQ(h.formats, (std::vector<std::string>{"drc", "glb"}));
  EXPECT_EQ(h.credit_bytes, 42U);
  const auto held = decode(encode(Held{{{{3, -1, 2, -3}, 9}}}));
  EXPECT_EQ(std::get<Held>(held->message).chunks, (std::vector<HeldChunk>{{{3, -1, 2, -3}, 9}}));
}

TEST(Message, NamesStripsByFacesThatAChunkHas) {
  const auto want = decode(encode(Want{{}, {{{3, -1, 2, -3}, ChunkFace::kNz}}}));
  EXPECT_EQ(std::get<Want>(want->message).strips, (std::vector<StripKey>{{{3, -1, 2, -3}, ChunkFace::kNz}}));
  const std::vector<std::byte> head = encode(StripHead{{{3, -1, 2, -3}, static_cast<ChunkFace>(6)}, 0, 0});
  EXPECT_EQ(decode(head).error(), MessageError::kBadKey);
  EXPECT_EQ(decode(encode(Want{{}, {{{3, -1, 2, -3}, static_cast<ChunkFace>(6)}}})).error(), MessageError::kBadKey);
}

TEST(Message, NamesWhatCannotBeMadeByChunkOrByFace) {
  const auto chunk = decode(encode(Failed{{3, -1, 2, -3}}));
  EXPECT_EQ(std::get<Failed>(chunk->message).key, (ChunkKey{3, -1, 2, -3}));
  EXPECT_FALSE(std::get<Failed>(chunk->message).face);
  const auto strip = decode(encode(Failed{{3, -1, 2, -3}, ChunkFace::kNz}));
  EXPECT_EQ(std::get<Failed>(strip->message).face, ChunkFace::kNz);
  EXPECT_EQ(decode(encode(Failed{{3, -1, 2, -3}, static_cast<ChunkFace>(6)})).error(), MessageError::kBadKey);
  EXPECT_EQ(decode(encode(Failed{{3, -1, 2, -3}, static_cast<ChunkFace>(0xFE)})).error(), MessageError::kBadKey);
  EXPECT_EQ(decode(encode(Failed{{kLodMax + 1, 0, 0, 0}})).error(), MessageError::kBadKey);
}

TEST(Message, GivesAViewAsItCame) {
  ViewMessage message;
  message.view.near_m = std::numeric_limits<double>::quiet_NaN();
  message.view.position.x = std::numeric_limits<double>::infinity();
  const auto decoded = decode(encode(message));
  ASSERT_TRUE(decoded);
  const View& view = std::get<ViewMessage>(decoded->message).view;
  EXPECT_TRUE(std::isnan(view.near_m));
  EXPECT_TRUE(std::isinf(view.position.x));
}

TEST(Message, GivesTheExactPayloadOfAChunk) {
  std::vector<std::byte> bytes = encode(ChunkHead{{0, 1, 2, 3}, 0, ChunkKind::kMesh, 3});
  EXPECT_LE(bytes.size(), kChunkHeadBytesMax);
  bytes.insert(bytes.end(), {std::byte{7}, std::byte{8}, std::byte{9}});
  const auto decoded = decode(bytes);
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->payload.size(), 3U);
  EXPECT_EQ(decoded->payload.data(), bytes.data() + bytes.size() - 3);
  bytes.push_back(std::byte{10});
  EXPECT_EQ(decode(bytes).error(), MessageError::kMalformed);
}

TEST(Message, IsRefusedAtEveryStrictPrefix) {
  for (const Message& message : one_of_each()) {
    const std::vector<std::byte> bytes = whole(message);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::vector<std::byte> prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_FALSE(decode(prefix)) << name_of(message) << " cut to " << size;
    }
  }
}

TEST(Message, WithBytesBehindItsEndIsRefused) {
  for (const Message& message : one_of_each()) {
    std::vector<std::byte> bytes = whole(message);
    bytes.push_back(std::byte{0});
    EXPECT_FALSE(decode(bytes)) << name_of(message);
  }
}

TEST(Message, SurvivesRandomMutations) {
  std::mt19937_64 random(20261122);
  std::size_t refused = 0;
  for (const Message& message : one_of_each()) {
    const std::vector<std::byte> original = whole(message);
    for (int round = 0; round < 3000; ++round) {
      std::vector<std::byte> bytes = original;
      const auto flips = 1 + random() % 8;
      for (std::uint64_t i = 0; i < flips; ++i) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
      if (random() % 4 == 0) bytes.resize(random() % (bytes.size() + 1));
      const auto decoded = decode(bytes);
      if (!decoded) {
        ++refused;
      } else {
        // What is let in can be written again: every limit of encode holds for it.
        EXPECT_FALSE(encode(decoded->message).empty());
      }
    }
  }
  EXPECT_GT(refused, 1000U);
}

TEST(Message, WithTheMostKeysFitsTheInboundLimit) {
  Held held;
  held.chunks.resize(kKeysPerMessageMax);
  const std::vector<std::byte> bytes = encode(held);
  EXPECT_LE(bytes.size(), kInboundMessageBytesMax);
  EXPECT_TRUE(decode(bytes));
}

TEST(Message, AlignsListsWhateverTheirLength) {
  for (std::size_t size = 0; size < 20; ++size) {
    Held held;
    for (std::size_t i = 0; i < size; ++i) held.chunks.push_back({{0, static_cast<int>(i), 0, 0}, 0x1122334455667788});
    const std::vector<std::byte> bytes = encode(held);
    // The revisions lie where a reader that maps the head on to aligned memory finds them: at multiples of 8.
    for (std::size_t at = kPrefixBytes; at + 8 <= bytes.size(); ++at) {
      std::uint64_t value = 0;
      std::memcpy(&value, bytes.data() + at, sizeof value);
      EXPECT_TRUE(value != 0x1122334455667788 || (at - kPrefixBytes) % 8 == 0) << size;
    }
    const auto decoded = decode(bytes);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(std::get<Held>(decoded->message).chunks, held.chunks);
  }
}

TEST(Message, WithAKeyOutsideTheWorldIsRefused) {
  const ChunkKey beyond{0, kChunkLimit + 1, 0, 0};
  EXPECT_EQ(decode(encode(Leave{{beyond}})).error(), MessageError::kBadKey);
  EXPECT_EQ(decode(encode(Held{{{beyond, 0}}})).error(), MessageError::kBadKey);
  EXPECT_EQ(decode(encode(Want{{{{-1, 0, 0, 0}, 0}}})).error(), MessageError::kBadKey);
  EXPECT_EQ(decode(encode(ChunkHead{{kLodMax + 1, 0, 0, 0}, 0, ChunkKind::kAir, 0})).error(), MessageError::kBadKey);
}

TEST(Message, WithATextBeyondItsLimitIsRefused) {
  EXPECT_EQ(decode(encode(Hello{1, 1, std::string(kNameBytesMax + 1, 'w'), "", {}, 0, ""})).error(),
            MessageError::kTooLarge);
  EXPECT_EQ(decode(encode(Bye{ByeReason::kLeaving, std::string(kTextBytesMax + 1, 'w')})).error(),
            MessageError::kTooLarge);
  EXPECT_EQ(decode(encode(Hello{1, 1, "w", "", std::vector<std::string>(kFormatsMax + 1, "drc"), 0, ""})).error(),
            MessageError::kTooLarge);
}

TEST(Message, WithTextThatIsNotUtf8IsRefused) {
  for (const char* text : {"\xFF", "\xC0\x80", "\xED\xA0\x80", "\xE2\x82", "\xF5\x80\x80\x80"}) {
    EXPECT_EQ(decode(encode(Hello{1, 1, text, "", {}, 0, ""})).error(), MessageError::kMalformed);
  }
  EXPECT_TRUE(decode(encode(Hello{1, 1, "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x8F\x94", "", {}, 0, ""})));
}

TEST(Message, LargerThanAnyMessageIsRefusedUnread) {
  EXPECT_EQ(decode(std::vector<std::byte>(kOutboundMessageBytesMax + 1)).error(), MessageError::kTooLarge);
  std::vector<std::byte> declares_too_much(8, std::byte{0xFF});
  EXPECT_EQ(decode(declares_too_much).error(), MessageError::kTooLarge);
}

}  // namespace
}  // namespace talus::protocol
