#include "core/base/check.hpp"
#include "protocol/message.hpp"
#include "tests/fuzz/fuzz_one.hpp"

int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::protocol;
  const auto decoded = decode(std::as_bytes(std::span(data, size)));
  if (!decoded) return 0;
  // What was let in can be sent on, and means the same then.
  std::vector<std::byte> again = encode(decoded->message);
  again.insert(again.end(), decoded->payload.begin(), decoded->payload.end());
  const auto twice = decode(again);
  TALUS_CHECK(twice.has_value());
  TALUS_CHECK(encode(twice->message) == encode(decoded->message));
  return 0;
}
