#include "client_sample/library/length_frames.hpp"

#include <gtest/gtest.h>

#include "tests/support/random.hpp"

namespace talus::client {
namespace {

using Bytes = std::vector<std::byte>;
using test::noise;

TEST(LengthReader, GivesBackWhatWasFramedHoweverItIsCut) {
  const std::vector<std::size_t> sizes{1, 0, 255, 256, 65'536, 3};
  Bytes stream;
  for (const std::size_t size : sizes) {
    const Bytes frame = length_frame(noise(size));
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  for (const std::size_t cut : {std::size_t{1}, std::size_t{7}, std::size_t{4096}, stream.size()}) {
    LengthReader reader(65'536);
    std::vector<Bytes> messages;
    for (std::size_t at = 0; at < stream.size(); at += cut) {
      reader.feed(std::span(stream).subspan(at, std::min(cut, stream.size() - at)));
      while (const auto event = reader.next()) {
        ASSERT_EQ(event->kind, LengthReader::Event::Kind::kMessage);
        messages.emplace_back(event->bytes.begin(), event->bytes.end());
      }
    }
    ASSERT_EQ(messages.size(), sizes.size()) << "in pieces of " << cut;
    for (std::size_t i = 0; i < sizes.size(); ++i) EXPECT_EQ(messages[i], noise(sizes[i]));
  }
}

TEST(LengthReader, RefusesALengthBeforeItsBytesCome) {
  LengthReader reader(4096);
  const Bytes head{std::byte{1}, std::byte{16}, std::byte{0}, std::byte{0}};  // 4097
  reader.feed(head);
  const auto event = reader.next();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind, LengthReader::Event::Kind::kFault);
  EXPECT_FALSE(event->fault.empty());
  reader.feed(head);
  EXPECT_FALSE(reader.next()) << "nothing is read behind a fault";
}

}  // namespace
}  // namespace talus::client
