#include "client_sample/cli/files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/scratch_folder.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

class ReplaceFile : public testing::Test {
 protected:
  std::string content() const { return load_file(path(), 1 << 20).value_or("unreadable"); }
  std::string path() const { return folder / "progress"; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
  }

  const test::ScratchFolder folder;
};

/// From here on the process may write files of so many bytes. The kernel writes as far as that and then, unless SIGXFSZ
/// is ignored, kills the process: a power cut as a test can have it.
void write_at_most(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) std::_Exit(1);
}

TEST_F(ReplaceFile, MakesAFileAndReplacesIt) {
  EXPECT_TRUE(replace_file(path(), "first"));
  EXPECT_EQ(content(), "first");
  EXPECT_TRUE(replace_file(path(), "2"));
  EXPECT_EQ(content(), "2");
  EXPECT_EQ(files(), 1U) << "nothing is left beside it";
}

TEST_F(ReplaceFile, LeavesTheOldBytesWhenItsProcessDiesHalfWay) {
  ASSERT_TRUE(replace_file(path(), "old"));
  const auto die_half_way = [&] {
    std::signal(SIGXFSZ, SIG_DFL);
    write_at_most(1000);
    replace_file(path(), std::string(10'000, 'n'));
  };
  EXPECT_EXIT(die_half_way(), testing::KilledBySignal(SIGXFSZ), "");
  EXPECT_EQ(content(), "old");
  EXPECT_EQ(files(), 2U) << "it did not die half way";
  EXPECT_TRUE(replace_file(path(), "new"));
  EXPECT_EQ(content(), "new");
  EXPECT_EQ(files(), 1U);
}

TEST_F(ReplaceFile, LeavesTheOldBytesAndNothingElseWhenTheDiskIsFull) {
  ASSERT_TRUE(replace_file(path(), "old"));
  const auto fail_half_way = [&] {
    std::signal(SIGXFSZ, SIG_IGN);
    write_at_most(1000);
    std::_Exit(replace_file(path(), std::string(10'000, 'n')) ? 1 : 0);
  };
  EXPECT_EXIT(fail_half_way(), testing::ExitedWithCode(0), "cannot write");
  EXPECT_EQ(content(), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(ReplaceFile, FollowsALinkAndKeepsIt) {
  std::ofstream(folder / "elsewhere") << "old";
  fs::create_symlink(folder / "elsewhere", path());
  EXPECT_TRUE(replace_file(path(), "new"));
  EXPECT_TRUE(fs::is_symlink(path()));
  EXPECT_EQ(load_file(folder / "elsewhere", 100), "new");

  fs::remove(path());
  fs::create_symlink("/dev/full", path());
  EXPECT_FALSE(replace_file(path(), "new"));
  EXPECT_TRUE(fs::is_symlink(path())) << "a device is no file to put another in the place of";
}

}  // namespace
}  // namespace talus::cli
