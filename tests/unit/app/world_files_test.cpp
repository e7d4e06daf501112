#include "server/app/world_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace talus::server {
namespace {

TEST(WorldFiles, OfTheProjectAreAllServedTogether) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TALUS_SOURCE_DIR) + "/deploy/worlds")) {
    files.push_back(entry.path().string());
  }
  const auto worlds = load_worlds(files);
  ASSERT_TRUE(worlds) << worlds.error();
  EXPECT_EQ(worlds->size(), files.size());
  EXPECT_LT(world_index(*worlds, "alpine"), worlds->size());
}

TEST(WorldFiles, ThatCannotBeReadAreNamed) {
  const std::vector<std::string> files{"/no/such/world.toml"};
  const auto worlds = load_worlds(files);
  ASSERT_FALSE(worlds);
  EXPECT_NE(worlds.error().find("/no/such/world.toml"), std::string::npos);
}

}  // namespace
}  // namespace talus::server
