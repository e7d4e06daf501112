#include "client_sample/library/websocket_frames.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/random.hpp"

namespace talus::client {
namespace {

using Kind = FrameReader::Event::Kind;
using Bytes = std::vector<std::byte>;
using test::noise;

Bytes bytes_of(std::initializer_list<int> values) {
  Bytes out;
  for (const int v : values) out.push_back(static_cast<std::byte>(v));
  return out;
}

/// A frame as servers send them: not masked.
Bytes server_frame(int first, const Bytes& payload) {
  Bytes out = bytes_of({first});
  const std::size_t size = payload.size();
  if (size < 126) {
    out.push_back(static_cast<std::byte>(size));
  } else if (size < 65536) {
    out.push_back(std::byte{126});
    for (const int shift : {8, 0}) out.push_back(static_cast<std::byte>(size >> shift));
  } else {
    out.push_back(std::byte{127});
    for (int shift = 56; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(size >> shift));
  }
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

TEST(FrameReader, GivesMessagesOfEveryLengthWhole) {
  for (const std::size_t size : {0U, 1U, 125U, 126U, 65535U, 65536U, 300'000U}) {
    FrameReader reader(1 << 20);
    const Bytes payload = noise(size);
    const Bytes frame = server_frame(0x82, payload);
    reader.feed(frame);
    const auto event = reader.next();
    ASSERT_TRUE(event) << size;
    EXPECT_EQ(event->kind, Kind::kMessage);
    EXPECT_TRUE(std::equal(event->bytes.begin(), event->bytes.end(), payload.begin(), payload.end()));
    EXPECT_FALSE(reader.next());
  }
}

TEST(FrameReader, DoesNotCareHowBytesAreCut) {
  Bytes stream;
  for (int i = 0; i < 20; ++i) {
    const Bytes frame = server_frame(0x82, noise(static_cast<std::size_t>(i * 37)));
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  FrameReader reader(4096);
  std::size_t messages = 0;
  for (const std::byte b : stream) {
    reader.feed({&b, 1});
    while (const auto event = reader.next()) {
      ASSERT_EQ(event->kind, Kind::kMessage);
      EXPECT_EQ(event->bytes.size(), messages * 37);
      ++messages;
    }
  }
  EXPECT_EQ(messages, 20U);
}

TEST(FrameReader, JoinsFragmentsAndLetsControlFramesThroughBetweenThem) {
  Bytes stream = server_frame(0x02, bytes_of({1, 2}));
  for (const Bytes& frame :
       {server_frame(0x89, bytes_of({9})), server_frame(0x00, {}), server_frame(0x80, bytes_of({3}))}) {
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  FrameReader reader(100);
  reader.feed(stream);
  auto event = reader.next();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind, Kind::kPing);
  EXPECT_EQ(event->bytes.size(), 1U);
  event = reader.next();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind, Kind::kMessage);
  EXPECT_EQ(Bytes(event->bytes.begin(), event->bytes.end()), bytes_of({1, 2, 3}));
}

TEST(FrameReader, FindsEveryBreachOfTheProtocol) {
  const std::vector<Bytes> breaches{
      bytes_of({0x82, 0x81, 0, 0, 0, 0, 1}),  // masked
      bytes_of({0xC2, 0x01, 1}),              // RSV1
      bytes_of({0x81, 0x01, 'a'}),            // text
      bytes_of({0x83, 0x00}),                 // reserved opcode
      bytes_of({0x8B, 0x00}),                 // reserved control opcode
      bytes_of({0x09, 0x00}),                 // fragmented ping
      bytes_of({0x89, 126, 0, 126}),          // long ping
      bytes_of({0x80, 0x00}),                 // continuation of nothing
      bytes_of({0x02, 0x00, 0x82, 0x00}),     // message inside a message
      bytes_of({0x82, 126, 0x10, 0x01}),      // 4097 bytes
      bytes_of({0x82, 127, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}),
      bytes_of({0x02, 126, 0x10, 0x00}),  // 4096 bytes, and ...
  };
  for (std::size_t i = 0; i < breaches.size(); ++i) {
    FrameReader reader(4096);
    Bytes stream = breaches[i];
    if (i + 1 == breaches.size()) {
      const Bytes rest(4096);
      stream.insert(stream.end(), rest.begin(), rest.end());
      const Bytes more = bytes_of({0x80, 0x01});  // ... one more
      stream.insert(stream.end(), more.begin(), more.end());
    }
    reader.feed(stream);
    const auto event = reader.next();
    ASSERT_TRUE(event) << i;
    EXPECT_EQ(event->kind, Kind::kFault) << i;
    EXPECT_FALSE(event->fault.empty());
    EXPECT_FALSE(reader.next()) << "nothing is read behind a fault";
  }
}

TEST(FrameReader, TellsTheCloseCode) {
  FrameReader reader(100);
  const Bytes frame = server_frame(0x88, bytes_of({0x03, 0xE9, 'b', 'y', 'e'}));
  reader.feed(frame);
  const auto event = reader.next();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind, Kind::kClose);
  EXPECT_EQ(event->close_code, 1001);
}

TEST(MaskedFrame, UnmasksToWhatWentIn) {
  for (const std::size_t size : {0U, 125U, 126U, 65535U, 65536U}) {
    const Bytes payload = noise(size);
    const Bytes frame = masked_frame(Opcode::kBinary, payload, 0x01020304);
    const std::size_t head = frame.size() - size;
    ASSERT_EQ(head, size < 126 ? 6U : size < 65536 ? 8U : 14U);
    EXPECT_EQ(frame[0], std::byte{0x82});
    EXPECT_NE(frame[1] & std::byte{0x80}, std::byte{0});
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(frame[head + i] ^ frame[head - 4 + i % 4], payload[i]);
  }
}

}  // namespace
}  // namespace talus::client
