#include "server/storage/entry.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace talus::server {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

constexpr std::string_view kName = "world 1 0/1/2/3";

TEST(Entry, IsReadBackAsItWasWritten) {
  for (const std::string& text : {std::string(), std::string("x"), std::string(5000, 'm')}) {
    const auto payload = bytes_of(text);
    const auto kind = decode_entry(kName, encode_entry_head(kName, 2, payload), payload);
    ASSERT_TRUE(kind.has_value());
    EXPECT_EQ(*kind, 2);
  }
}

TEST(Entry, IsRefusedWhenAnyBitOfItIsAnother) {
  auto payload = bytes_of("forty bytes of payload, more or less, ok");
  EntryHead head = encode_entry_head(kName, 2, payload);
  const auto flips = [&](std::byte& byte) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      byte ^= std::byte{1} << bit;
      EXPECT_FALSE(decode_entry(kName, head, payload).has_value());
      byte ^= std::byte{1} << bit;
    }
  };
  for (std::byte& byte : head) flips(byte);
  for (std::byte& byte : payload) flips(byte);
  EXPECT_TRUE(decode_entry(kName, head, payload).has_value());
}

TEST(Entry, IsRefusedWhenItIsCutOrLonger) {
  auto payload = bytes_of("payload");
  const EntryHead head = encode_entry_head(kName, 2, payload);
  const std::span<const std::byte> whole(head);
  for (std::size_t size = 0; size < head.size(); ++size) {
    EXPECT_EQ(decode_entry(kName, whole.first(size), payload).error(), EntryFault::kTruncated);
  }
  for (std::size_t size = 0; size < payload.size(); ++size) {
    EXPECT_EQ(decode_entry(kName, head, std::span(payload).first(size)).error(), EntryFault::kTruncated);
  }
  payload.push_back(std::byte{0});
  EXPECT_EQ(decode_entry(kName, head, payload).error(), EntryFault::kSize);
}

TEST(Entry, IsRefusedUnderAnotherName) {
  const auto payload = bytes_of("payload");
  const EntryHead head = encode_entry_head(kName, 2, payload);
  EXPECT_EQ(decode_entry("world 2 0/1/2/3", head, payload).error(), EntryFault::kChecksum);
  EXPECT_EQ(decode_entry("", head, payload).error(), EntryFault::kChecksum);
}

TEST(Entry, HasAPlaceThatFollowsFromItsName) {
  EXPECT_EQ(entry_place("a"), entry_place("a"));
  EXPECT_NE(entry_place("a"), entry_place("b"));
  // The first 8 bytes of SHA-256("abc"), little-endian: files outlive this program.
  EXPECT_EQ(static_cast<std::uint64_t>(entry_place("abc")), 0xeacf018fbf1678baULL);
}

}  // namespace
}  // namespace talus::server
