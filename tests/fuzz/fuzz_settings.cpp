#include "core/base/check.hpp"
#include "server/app/settings.hpp"
#include "tests/fuzz/fuzz_one.hpp"

// A file of settings: refused with what is wrong, or read, and then printed and read again to the same.
int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::server;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Settings settings;
  if (const auto set = set_from_toml(settings, text, "fuzz.toml"); !set) {
    TALUS_CHECK(!set.error().empty());
    return 0;
  }
  const std::string printed = format_settings(settings);
  Settings again;
  if (setting_faults(settings).empty()) {
    TALUS_CHECK(set_from_toml(again, printed, "again.toml").has_value());
    TALUS_CHECK(format_settings(again) == printed);
  }
  return 0;
}
