// Reads every source of the project and holds the rules of the house. Each rule is also tried on a source that breaks
// it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/unit/house/source_rules.hpp"

namespace talus::house {
namespace {

namespace fs = std::filesystem;

bool is_generated_or_foreign(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return name == "node_modules" || name == "generated" || name == "dist" || name == "screenshots";
}

bool is_source(const fs::path& path) {
  const std::string end = path.extension().string();
  return end == ".cpp" || end == ".hpp" || end == ".ts" || end == ".mjs";
}

std::vector<Source> sources_of_the_project() {
  std::vector<Source> out;
  const fs::path root = TALUS_SOURCE_DIR;
  for (const char* const top : {"core", "protocol", "server", "client_sample", "tests"}) {
    if (!fs::exists(root / top)) continue;
    for (auto entry = fs::recursive_directory_iterator(root / top); entry != fs::recursive_directory_iterator();
         ++entry) {
      if (entry->is_directory() && is_generated_or_foreign(entry->path())) entry.disable_recursion_pending();
      if (!entry->is_regular_file() || !is_source(entry->path())) continue;
      std::ifstream file(entry->path(), std::ios::binary);
      out.push_back({fs::relative(entry->path(), root).generic_string(),
                     std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>())});
    }
  }
  return out;
}

bool is_cpp(const Source& source) {
  return source.path.ends_with(".cpp") || source.path.ends_with(".hpp");
}

std::string describe(const std::vector<Fault>& faults) {
  std::string out;
  for (const Fault& fault : faults) {
    out += '\n' + fault.path + ':' + std::to_string(fault.line) + ": " + fault.message;
  }
  return out;
}

template <typename Rule>
std::vector<Fault> faults_by(Rule rule, bool cpp_only) {
  std::vector<Fault> out;
  for (const Source& source : sources_of_the_project()) {
    if (cpp_only && !is_cpp(source)) continue;
    const std::vector<Fault> found = rule(source);
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

TEST(House, IsReadAtAll) {
  EXPECT_GT(sources_of_the_project().size(), 20U);
}

TEST(House, RoomsIncludeOnlyRoomsBelowThem) {
  const auto faults = faults_by(include_order_faults, true);
  EXPECT_TRUE(faults.empty()) << describe(faults);
}

TEST(House, LibrariesStayInTheRoomsThatOwnThem) {
  const auto faults = faults_by(library_faults, true);
  EXPECT_TRUE(faults.empty()) << describe(faults);
}

TEST(House, HeavyLibrariesAreCompiledInFewSources) {
  const auto faults = heavy_library_faults(sources_of_the_project());
  EXPECT_TRUE(faults.empty()) << describe(faults);
}

TEST(House, TypesHaveOneDefinition) {
  const std::vector<Fault> faults = one_definition_faults(sources_of_the_project());
  EXPECT_TRUE(faults.empty()) << describe(faults);
}

TEST(House, FilesAreShortAndFinishedAndStartNoThreadsOfTheirOwn) {
  const auto faults = faults_by(text_faults, false);
  EXPECT_TRUE(faults.empty()) << describe(faults);
}

TEST(HouseRules, FindAnIncludeAgainstTheOrder) {
  EXPECT_EQ(include_order_faults({"core/grid/x.cpp", "#include \"core/world/manifest.hpp\"\n"}).size(), 1U);
  EXPECT_EQ(include_order_faults({"protocol/x.hpp", "\n#include \"server/world/world.hpp\"\n"}).at(0).line, 2U);
  EXPECT_EQ(include_order_faults({"server/world/x.cpp", "#  include \"server/net/session.hpp\"\n"}).size(), 1U);
  EXPECT_EQ(include_order_faults({"client_sample/cli/x.cpp", "#include \"server/app/config.hpp\"\n"}).size(), 1U);
  EXPECT_EQ(include_order_faults({"server/app/x.cpp", "#include \"tests/sim/net.hpp\"\n"}).size(), 1U);
  EXPECT_EQ(include_order_faults({"server/attic/x.cpp", ""}).size(), 1U);
}

TEST(HouseRules, AllowAnIncludeAlongTheOrder) {
  EXPECT_TRUE(include_order_faults({"core/mesh/x.cpp", "#include \"core/base/hash.hpp\"\n"}).empty());
  EXPECT_TRUE(include_order_faults({"core/mesh/x.cpp", "#include \"core/mesh/y.hpp\"\n#include <vector>\n"}).empty());
  EXPECT_TRUE(include_order_faults({"server/net/x.cpp", "#include \"protocol/message.hpp\"\n"}).empty());
}

TEST(HouseRules, FindALibraryOutsideItsRoom) {
  EXPECT_EQ(library_faults({"server/world/x.cpp", "#include <asio/post.hpp>\n"}).size(), 1U);
  EXPECT_EQ(library_faults({"client_sample/cli/x.cpp", "#include <draco/mesh/mesh.h>\n"}).size(), 1U);
  EXPECT_EQ(library_faults({"core/grid/x.cpp", "#include <thread>\n"}).size(), 1U);
  EXPECT_EQ(library_faults({"core/grid/x.cpp", "#include <fmt/core.h>\n"}).size(), 1U);
  EXPECT_TRUE(library_faults({"server/net/x.cpp", "#include <asio/post.hpp>\n"}).empty());
}

TEST(HouseRules, FindAHeavyLibraryInAHeaderOrInTooManySources) {
  EXPECT_EQ(heavy_library_faults({{"server/observe/log.hpp", "#include <spdlog/spdlog.h>\n"}}).size(), 1U);
  const Source one{"server/observe/a.cpp", "#include <spdlog/spdlog.h>\n#include <spdlog/async.h>\n"};
  const Source two{"server/observe/b.cpp", "#include <spdlog/spdlog.h>\n"};
  EXPECT_TRUE(heavy_library_faults({one}).empty());
  EXPECT_EQ(heavy_library_faults({one, two}).size(), 1U);
}

TEST(HouseRules, FindASecondDefinitionOfAType) {
  const auto source = [](const char* path, const std::string& space) {
    return Source{path, "namespace talus" + space + " {\nstruct Row final : Base {\n};\n}  // namespace\n"};
  };
  const Source one = source("core/noise/a.cpp", "");
  EXPECT_TRUE(one_definition_faults({one}).empty());
  EXPECT_EQ(one_definition_faults({one, source("core/grid/b.hpp", "")}).size(), 1U);
  EXPECT_TRUE(one_definition_faults({one, source("core/grid/b.hpp", "::other")}).empty());
  EXPECT_TRUE(one_definition_faults({one, source("core/grid/b.cpp", " {\nnamespace")}).empty()) << "it is nobody's";
}

TEST(HouseRules, FindThreadsClocksLongFilesAndUnfinishedWords) {
  EXPECT_EQ(text_faults({"server/world/x.cpp", "auto t = std::thread([] {});\n"}).size(), 1U);
  EXPECT_EQ(text_faults({"server/world/x.cpp", "const auto n = std::chrono::steady_clock::now();\n"}).size(), 1U);
  EXPECT_TRUE(text_faults({"server/schedule/clock.cpp", "return std::chrono::steady_clock::now();\n"}).empty());
  EXPECT_EQ(text_faults({"core/grid/x.hpp", std::string(201, '\n')}).size(), 1U);
  EXPECT_TRUE(text_faults({"core/grid/x.cpp", std::string(400, '\n')}).empty());
  EXPECT_EQ(text_faults({"core/grid/x.cpp",
                         "// TO"
                         "DO: later\n"})
                .size(),
            1U);
  EXPECT_EQ(text_faults({"core/grid/x.cpp",
                         "// zero for "
                         "now\n"})
                .size(),
            1U);
  EXPECT_TRUE(text_faults({"core/grid/x.cpp", "int todo_list = 0;  // a method, mastodon\n"}).empty());
}

}  // namespace
}  // namespace talus::house
