#include "server/net/framing.hpp"

#include <gtest/gtest.h>

#include <string>

#include "server/net/connection_census.hpp"
#include "server/net/http_answer.hpp"
#include "server/net/token_bucket.hpp"
#include "server/net/websocket_handshake.hpp"

namespace talus::server {
namespace {

using Kind = Inbound::Kind;

std::string text_of(std::span<const std::byte> bytes) {
  std::string out;
  for (const std::byte b : bytes) out += static_cast<char>(b);
  return out;
}
std::vector<std::byte> bytes_of(std::string_view text) {
  std::vector<std::byte> out;
  for (const char c : text) out.push_back(static_cast<std::byte>(c));
  return out;
}

/// A masked frame as a client sends it; `declared` overrides the length that the head states.
std::string frame(int first, std::string_view payload, std::uint64_t declared = ~std::uint64_t{0},
                  bool is_masked = true) {
  const std::uint64_t length = declared == ~std::uint64_t{0} ? payload.size() : declared;
  std::string out(1, static_cast<char>(first));
  const auto mask_bit = is_masked ? 0x80U : 0U;
  if (length < 126) {
    out += static_cast<char>(mask_bit | length);
  } else {
    const int size = length > 0xFFFF ? 8 : 2;
    out += static_cast<char>(mask_bit | (size == 8 ? 127U : 126U));
    for (int i = size; i-- > 0;) out += static_cast<char>(length >> (8 * i));
  }
  const std::string mask = "\x11\x22\x33\x44";
  if (is_masked) out += mask;
  for (std::size_t i = 0; i < payload.size(); ++i) {
    out += is_masked ? static_cast<char>(payload[i] ^ mask[i % 4]) : payload[i];
  }
  return out;
}

struct Event {
  Kind kind;
  std::string text;
  CloseCode code;
  friend bool operator==(const Event&, const Event&) = default;
};

/// Everything that comes of `wire`, fed in pieces of `piece` bytes.
std::vector<Event> read(Framing& framing, std::string_view wire, std::size_t piece) {
  std::vector<Event> out;
  for (std::size_t at = 0; at < wire.size(); at += piece) {
    const auto bytes = bytes_of(wire.substr(at, piece));
    framing.feed(bytes);
    while (const auto event = framing.next()) {
      out.push_back({event->kind, text_of(event->bytes), event->code});
      if (event->kind == Kind::kFault) return out;
    }
  }
  return out;
}

std::vector<Event> read_websocket(std::string_view wire, std::size_t piece = 7) {
  return read(*make_websocket_framing(65'536), wire, piece);
}

TEST(WebSocketFraming, ReadsMessagesHoweverTheBytesAreCut) {
  const std::string wire = frame(0x82, "one") + frame(0x82, std::string(300, 'x')) + frame(0x82, "");
  for (const std::size_t piece : {1UL, 2UL, 5UL, 1000UL}) {
    const auto events = read_websocket(wire, piece);
    ASSERT_EQ(events.size(), 3U) << piece;
    EXPECT_EQ(events[0].text, "one");
    EXPECT_EQ(events[1].text, std::string(300, 'x'));
    EXPECT_EQ(events[2].text, "");
  }
}

TEST(WebSocketFraming, JoinsFragmentsAndLetsControlFramesBetweenThem) {
  const auto events = read_websocket(frame(0x02, "ab") + frame(0x89, "hi") + frame(0x00, "cd") + frame(0x80, "ef"));
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0], (Event{Kind::kPing, "hi", CloseCode::kNormal}));
  EXPECT_EQ(events[1], (Event{Kind::kMessage, "abcdef", CloseCode::kNormal}));
}

TEST(WebSocketFraming, KnowsWhetherAMessageHasBegunHoweverTheBytesCame) {
  const std::string part = frame(0x02, "ab");
  const std::string ping = frame(0x89, "hi");
  const std::string last = frame(0x80, std::string(300, 'c'));
  const std::string whole = frame(0x82, std::string(70'000, 'x'));
  const auto is_between = [](std::initializer_list<std::string> pieces) {
    const auto framing = make_websocket_framing(100'000);
    for (const std::string& piece : pieces) read(*framing, piece, piece.size());
    return framing->is_between_messages();
  };
  EXPECT_TRUE(is_between({}));
  EXPECT_TRUE(is_between({ping}));
  EXPECT_TRUE(is_between({whole, whole + ping}));
  EXPECT_TRUE(is_between({part + ping + last}));
  EXPECT_FALSE(is_between({part}));
  EXPECT_FALSE(is_between({part + ping})) << "a ping ends no message";
  EXPECT_FALSE(is_between({ping + whole.substr(0, 1)})) << "one byte came together with the frame before";
  EXPECT_FALSE(is_between({whole.substr(0, 69'000)}));
}

TEST(WebSocketFraming, EndsOnWhatNoClientMaySend) {
  struct Case {
    const char* why;
    std::string wire;
    CloseCode code;
  };
  const std::vector<Case> kTable{
      {"unmasked", frame(0x82, "abc", ~std::uint64_t{0}, false), CloseCode::kProtocol},
      {"text", frame(0x81, "abc"), CloseCode::kUnsupported},
      {"reserved bits", frame(0xC2, "abc"), CloseCode::kProtocol},
      {"unknown data opcode", frame(0x83, "abc"), CloseCode::kProtocol},
      {"unknown control opcode", frame(0x8B, "abc"), CloseCode::kProtocol},
      {"a continuation of nothing", frame(0x80, "abc"), CloseCode::kProtocol},
      {"a message inside a message", frame(0x02, "ab") + frame(0x82, "cd"), CloseCode::kProtocol},
      {"a fragmented ping", frame(0x09, "abc"), CloseCode::kProtocol},
      {"a long ping", frame(0x89, std::string(126, 'a')), CloseCode::kProtocol},
      {"a message too long by one", frame(0x82, "a", 65'537), CloseCode::kTooBig},
      {"a message of 2^62 bytes", frame(0x82, "a", std::uint64_t{1} << 62), CloseCode::kTooBig},
      {"fragments too long together", frame(0x02, std::string(40'000, 'a')) + frame(0x80, std::string(40'000, 'a')),
       CloseCode::kTooBig},
  };
  for (const Case& c : kTable) {
    const auto events = read_websocket(c.wire, 4096);
    ASSERT_FALSE(events.empty()) << c.why;
    EXPECT_EQ(events.back().kind, Kind::kFault) << c.why;
    EXPECT_EQ(events.back().code, c.code) << c.why;
  }
}

TEST(WebSocketFraming, WritesTheShortestLength) {
  const auto framing = make_websocket_framing(100);
  EXPECT_EQ(framing->message_head(125).size, 2U);
  EXPECT_EQ(framing->message_head(126).size, 4U);
  EXPECT_EQ(framing->message_head(65'535).size, 4U);
  EXPECT_EQ(framing->message_head(65'536).size, 10U);
  EXPECT_EQ(text_of(framing->close(CloseCode::kGoingAway, "bye")),
            "\x88\x05\x03\xe9"
            "bye");
}

TEST(TcpFraming, ReadsMessagesHoweverTheBytesAreCut) {
  const std::string wire = std::string("\x03\0\0\0abc\0\0\0\0\x01\0\0\0d", 16);
  for (const std::size_t piece : {1UL, 3UL, 100UL}) {
    const auto events = read(*make_tcp_framing(100), wire, piece);
    ASSERT_EQ(events.size(), 3U) << piece;
    EXPECT_EQ(events[0].text, "abc");
    EXPECT_EQ(events[1].text, "");
    EXPECT_EQ(events[2].text, "d");
  }
}

TEST(TcpFraming, EndsOnADeclaredLengthBeyondTheLimit) {
  const auto events = read(*make_tcp_framing(100), std::string("\x65\0\0\0", 4), 10);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].code, CloseCode::kTooBig);
}

TEST(WebSocketHandshake, AnswersTheKeyOfTheSpecification) {
  EXPECT_EQ(websocket_accept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

TEST(WebSocketHandshake, SaysWhatIsMissing) {
  const auto status = [](std::initializer_list<HttpField> fields) {
    HttpRequest request;
    request.method = HttpMethod::kGet;
    for (const HttpField& field : fields) request.fields.push(field);
    const auto done = websocket_handshake(request);
    return done ? 101 : done.error().status;
  };
  const HttpField upgrade{"Upgrade", "websocket"};
  const HttpField connection{"Connection", "keep-alive, Upgrade"};
  const HttpField version{"Sec-WebSocket-Version", "13"};
  const HttpField key{"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="};
  EXPECT_EQ(status({upgrade, connection, version, key}), 101);
  EXPECT_EQ(status({connection, version, key}), 426);
  EXPECT_EQ(status({upgrade, version, key}), 426);
  EXPECT_EQ(status({upgrade, connection, key}), 426);
  EXPECT_EQ(status({upgrade, connection, {"Sec-WebSocket-Version", "8"}, key}), 426);
  EXPECT_EQ(status({upgrade, connection, version}), 400);
  EXPECT_EQ(status({upgrade, connection, version, {"Sec-WebSocket-Key", "short"}}), 400);
}

TEST(TokenBucket, AllowsABurstAndThenItsRate) {
  Instant now{};
  TokenBucket bucket(60, 120, now);
  for (int i = 0; i < 120; ++i) EXPECT_TRUE(bucket.take(1, now));
  EXPECT_FALSE(bucket.take(1, now));
  now += std::chrono::milliseconds(500);
  for (int i = 0; i < 30; ++i) EXPECT_TRUE(bucket.take(1, now)) << i;
  EXPECT_FALSE(bucket.take(1, now));
}

TEST(ConnectionCensus, CountsAllAndEachAddress) {
  ConnectionCensus census;
  const PeerAddress a{1};
  const PeerAddress b{2};
  using Verdict = ConnectionCensus::Verdict;
  const auto first = census.enter(a, 3, 2);
  {
    const auto second = census.enter(a, 3, 2);
    EXPECT_EQ(census.enter(a, 3, 2).first, Verdict::kTooManyFromAddress);
    const auto third = census.enter(b, 3, 2);
    EXPECT_EQ(census.enter(b, 3, 2).first, Verdict::kTooMany);
  }
  EXPECT_EQ(census.connections(), 1U);
  EXPECT_EQ(census.enter(a, 3, 2).first, Verdict::kWelcome);
}

TEST(HttpDate, IsTheOneOfTheSpecification) {
  EXPECT_EQ(http_date(784'111'777), "Sun, 06 Nov 1994 08:49:37 GMT");
}

}  // namespace
}  // namespace talus::server
