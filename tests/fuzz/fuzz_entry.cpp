#include "core/base/check.hpp"
#include "server/storage/entry.hpp"
#include "tests/fuzz/fuzz_one.hpp"

#include <algorithm>
#include <span>
#include <string_view>

// A disk's bytes, as head and payload of an entry. What is let in is exactly what would be written.
int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::server;
  constexpr std::string_view kName = "fuzz";
  const std::span<const std::byte> all = std::as_bytes(std::span(data, size));
  const auto head = all.first(std::min(size, kEntryHeadBytes));
  const auto payload = all.subspan(head.size());
  const auto kind = decode_entry(kName, head, payload);
  if (kind) TALUS_CHECK(std::ranges::equal(encode_entry_head(kName, *kind, payload), head));
  return 0;
}
