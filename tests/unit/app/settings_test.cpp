#include "server/app/settings.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "server/app/command_line.hpp"

namespace talus::server {
namespace {

std::string fault_of(std::string_view toml) {
  Settings settings;
  const auto set = set_from_toml(settings, toml, "talusd.toml");
  return set ? "" : protocol::describe(set.error().front());
}

template <typename... Args>
std::variant<Serve, PrintAndEnd> parse(Args... args) {
  const std::vector<const char*> argv{"talusd", args...};
  return parse_command_line(static_cast<int>(argv.size()), argv.data());
}

TEST(Settings, NamesAListenerForTlsOnlyWithACertificate) {
  Settings settings;
  EXPECT_TRUE(setting_faults(settings).empty());
  settings.tls_on = {"listen"};
  const auto faults = setting_faults(settings);
  ASSERT_EQ(faults.size(), 1U) << "not in clear without a word";
  EXPECT_EQ(faults[0].key, "tls_on");
  settings.tls_certificate = "a.pem";
  settings.tls_key = "a.key";
  EXPECT_TRUE(setting_faults(settings).empty());
}

TEST(Settings, ReadBackWhatTheyPrint) {
  Settings settings;
  settings.world = {"a.toml", "b \"c\".toml"};
  settings.cache_mib = 77;
  settings.limits.idle_s = 2.5;
  Settings read;
  const auto set = set_from_toml(read, format_settings(settings), "printed");
  ASSERT_TRUE(set.has_value()) << protocol::describe(set.error().front());
  EXPECT_EQ(read.world, settings.world);
  EXPECT_EQ(read.cache_mib, 77U);
  EXPECT_EQ(read.limits.idle_s, 2.5);
  EXPECT_EQ(format_settings(read), format_settings(settings));
}

TEST(Settings, SayFileLineKeyAndRangeOfWhatIsWrong) {
  EXPECT_EQ(fault_of("threads = 1\ncache_mib = 0\n").substr(0, 25), "talusd.toml:2: cache_mib:");
  EXPECT_NE(fault_of("cache_mib = 0").find("1..1048576"), std::string::npos);
  EXPECT_NE(fault_of("cach_mib = 5").find("cache_mib"), std::string::npos) << "the nearest key is named";
  EXPECT_NE(fault_of("\nlisten = \"nowhere\"").find("talusd.toml:2: listen:"), std::string::npos);
  EXPECT_NE(fault_of("ping_s = 50\ngone_s = 40").find(":2: gone_s: is not above ping_s"), std::string::npos);
  EXPECT_NE(fault_of("threads = \"many\"").size(), 0U);
}

TEST(CommandLine, WinsOverTheFileAndTheFileOverTheDefault) {
  const std::string path = testing::TempDir() + "talusd_settings_test.toml";
  std::ofstream(path) << "cache_mib = 11\nthreads = 3\n";
  const auto parsed = parse("--config", path.c_str(), "--cache-mib", "22");
  ASSERT_TRUE(std::holds_alternative<Serve>(parsed)) << std::get<PrintAndEnd>(parsed).text;
  const Settings& settings = std::get<Serve>(parsed).settings;
  EXPECT_EQ(settings.cache_mib, 22U);
  EXPECT_EQ(settings.threads, 3U);
  EXPECT_EQ(settings.net_threads, 0U);
}

TEST(CommandLine, TakesWorldsMoreThanOnce) {
  const auto parsed = parse("--world", "a", "--world", "b");
  ASSERT_TRUE(std::holds_alternative<Serve>(parsed));
  EXPECT_EQ(std::get<Serve>(parsed).settings.world, (std::vector<std::string>{"a", "b"}));
}

TEST(CommandLine, ExplainsWhatItCannotTakeAndEndsWithTwo) {
  struct Case {
    std::vector<const char*> args;
    const char* says;
  };
  const std::vector<Case> kTable{
      {{"talusd", "--cache-mib", "0"}, "--cache-mib: 0 is out of range, allowed 1..1048576"},
      {{"talusd", "--cache-mib", "many"}, "'many' is not a whole number"},
      {{"talusd", "--threads", "1.5"}, "'1.5' is not a whole number"},
      {{"talusd", "--listen", "localhost:80"}, "expected ADDRESS:PORT"},
      {{"talusd", "--log-level", "loud"}, "expected debug"},
      {{"talusd", "--cach-mib", "5"}, "did you mean --cache-mib?"},
      {{"talusd", "--config", "/nowhere/at/all.toml"}, "/nowhere/at/all.toml: cannot be opened"},
      {{"talusd", "--check-config", "--world", "/nowhere.toml"}, "/nowhere.toml: cannot be opened"},
  };
  for (const Case& c : kTable) {
    const auto parsed = parse_command_line(static_cast<int>(c.args.size()), c.args.data());
    const auto* print = std::get_if<PrintAndEnd>(&parsed);
    ASSERT_NE(print, nullptr) << c.says;
    EXPECT_EQ(print->status, 2);
    EXPECT_NE(print->text.find(c.says), std::string::npos) << print->text;
  }
}

TEST(CommandLine, PrintsHelpVersionAndConfigurationAndEndsWell) {
  for (const char* flag : {"--help", "--version", "--print-config", "--check-config"}) {
    const auto parsed = parse(flag);
    const auto* print = std::get_if<PrintAndEnd>(&parsed);
    ASSERT_NE(print, nullptr) << flag;
    EXPECT_EQ(print->status, 0);
    EXPECT_FALSE(print->text.empty());
  }
}

}  // namespace
}  // namespace talus::server
