#include "server/world/stored_chunks.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace talus::server {
namespace {

namespace fs = std::filesystem;

class StoredChunksTest : public testing::Test {
 protected:
  StoredChunksTest() {
    worlds.push_back(std::make_unique<const World>(Manifest{}));
    name.key = {3, 1, 0, -2};
  }

  /// A process of one version of the generator on this disk; what it stores is on the disk when it ends.
  template <typename Act>
  void as_version(std::uint32_t version, Act act) {
    StoredChunks chunks(worlds, version);
    auto disk = DiskCache::open({folder.path().string(), 1 << 20, 1}, clock, metrics);
    ASSERT_TRUE(disk.has_value()) << disk.error();
    chunks.attach(std::move(*disk));
    act(chunks);
    chunks.flush();
  }
  void store(std::uint32_t version, std::byte content) {
    as_version(version, [&](StoredChunks& chunks) {
      const ChunkPayload payload{ChunkKind::kMesh, std::vector<std::byte>(100, content), 5};
      chunks.store(name, std::make_shared<const ChunkPayload>(payload), DiskCache::Commit::kNow);
    });
  }
  std::optional<ChunkPayload> load(std::uint32_t version) {
    std::optional<ChunkPayload> out;
    as_version(version, [&](StoredChunks& chunks) { out = chunks.load(name, 0); });
    return out;
  }

  const test::ScratchFolder folder;
  Worlds worlds;
  SystemClock clock;
  Metrics metrics;
  PayloadName name;
};

TEST_F(StoredChunksTest, GiveBackWhatWasStoredUnderTheSameName) {
  store(kGeneratorVersion, std::byte{1});
  const auto found = load(kGeneratorVersion);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->bytes, std::vector<std::byte>(100, std::byte{1}));
  EXPECT_EQ(found->kind, ChunkKind::kMesh);
  EXPECT_EQ(found->faces, 5);
  name.format = PayloadFormat::kDensity;
  EXPECT_FALSE(load(kGeneratorVersion));
}

TEST_F(StoredChunksTest, ANewerGeneratorNeverServesTheBytesOfAnOlderOne) {
  store(kGeneratorVersion, std::byte{1});
  EXPECT_FALSE(load(kGeneratorVersion + 1)) << "though world, key and format are the same";
  store(kGeneratorVersion + 1, std::byte{2});
  EXPECT_EQ(load(kGeneratorVersion + 1)->bytes, std::vector<std::byte>(100, std::byte{2}));
  EXPECT_EQ(load(kGeneratorVersion)->bytes, std::vector<std::byte>(100, std::byte{1})) << "nor the other way round";
}

TEST_F(StoredChunksTest, KeepNothingForAnOriginOfItsOwn) {
  name.format = PayloadFormat::kGlb;
  name.origin = {1, 0, 0};
  store(kGeneratorVersion, std::byte{1});
  EXPECT_FALSE(load(kGeneratorVersion));
}

}  // namespace
}  // namespace talus::server
