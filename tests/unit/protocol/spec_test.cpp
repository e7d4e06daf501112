// SPEC.md is read by people who write clients: what it shows has to be what we send.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "protocol/limits.hpp"
#include "protocol/message.hpp"

namespace talus::protocol {
namespace {

std::string spec() {
  std::ifstream file(std::string(TALUS_SOURCE_DIR) + "/protocol/SPEC.md");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The bytes of the fenced block that begins with ```hex NAME.
std::vector<std::byte> hex_block(const std::string& text, const std::string& name) {
  const std::string fence = "```hex " + name + "\n";
  const std::size_t begin = text.find(fence);
  if (begin == std::string::npos) return {};
  std::istringstream words(
      text.substr(begin + fence.size(), text.find("```", begin + fence.size()) - begin - fence.size()));
  std::vector<std::byte> out;
  for (std::string word; words >> word;) out.push_back(static_cast<std::byte>(std::stoul(word, nullptr, 16)));
  return out;
}

TEST(Spec, ShowsAChunkMessageThatDecodesToWhatItSays) {
  const std::vector<std::byte> bytes = hex_block(spec(), "chunk");
  ASSERT_EQ(bytes.size(), 79U);
  const auto decoded = decode(bytes);
  ASSERT_TRUE(decoded) << describe(decoded.error());
  const auto& chunk = std::get<ChunkHead>(decoded->message);
  EXPECT_EQ(chunk.key, (ChunkKey{2, -3, 4, -5}));
  EXPECT_EQ(chunk.revision, 6U);
  EXPECT_EQ(chunk.kind, ChunkKind::kMesh);
  ASSERT_EQ(decoded->payload.size(), 3U);
  EXPECT_EQ(decoded->payload[2], std::byte{0xCC});
}

TEST(Spec, ShowsTheBytesThatAreSent) {
  const std::vector<std::byte> bytes = hex_block(spec(), "chunk");
  const std::vector<std::byte> head = encode(ChunkHead{{2, -3, 4, -5}, 6, ChunkKind::kMesh, 3});
  ASSERT_EQ(head.size() + 3, bytes.size());
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
}

TEST(Spec, NamesTheLimitsOfTheCode) {
  const std::string text = spec();
  for (const std::size_t limit : {kHeadBytesMax, kOutboundMessageBytesMax, kInboundMessageBytesMax, kKeysPerMessageMax,
                                  kWantedKeysMax, kManifestJsonBytesMax, kTokenBytesMax, kTextBytesMax}) {
    EXPECT_NE(text.find(std::to_string(limit)), std::string::npos) << limit;
  }
}

}  // namespace
}  // namespace talus::protocol
