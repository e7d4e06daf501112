#include "core/base/check.hpp"
#include "protocol/manifest_toml.hpp"
#include "tests/fuzz/fuzz_one.hpp"

int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::protocol;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto manifest = parse_manifest(text, "fuzz.toml");
  if (!manifest) {
    TALUS_CHECK(!manifest.error().empty() && manifest.error().size() <= kTomlFaultsMax + 1);
    return 0;
  }
  const auto again = parse_manifest(format_manifest(*manifest), "again.toml");
  TALUS_CHECK(again.has_value() && *again == *manifest);
  return 0;
}
