#include "core/base/check.hpp"
#include "server/net/http_request.hpp"
#include "tests/fuzz/fuzz_one.hpp"

#include <string_view>

// The bytes of an HTTP connection. Where a head ends, or what is wrong with it, does not depend on how its bytes come;
// what is let in has one reading.
int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::server;
  const NetLimits limits;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  HeadScanner at_once(limits);
  const auto whole = at_once.scan(bytes);
  HeadScanner by_byte(limits);
  auto pieces = by_byte.scan({});
  for (std::size_t i = 1; i <= size && pieces && !*pieces; ++i) pieces = by_byte.scan(bytes.substr(0, i));
  TALUS_CHECK(whole.has_value() == pieces.has_value());
  if (!whole) {
    TALUS_CHECK(whole.error().code == pieces.error().code);
    return 0;
  }
  TALUS_CHECK(*whole == *pieces);
  if (!*whole) return 0;
  const std::string_view head = bytes.substr(0, **whole);
  TALUS_CHECK(head.ends_with("\r\n\r\n"));
  const auto request = parse_head(head, limits);
  if (!request) {
    TALUS_CHECK(request.error().status >= 400 && request.error().status < 500);
    return 0;
  }
  const auto is_inside = [&](std::string_view part) {
    return part.empty() || (part.data() >= head.data() && part.data() + part.size() <= head.data() + head.size());
  };
  TALUS_CHECK(is_inside(request->path) && is_inside(request->query));
  std::size_t hosts = 0;
  for (const auto& [name, value] : request->fields) {
    TALUS_CHECK(is_inside(name) && is_inside(value));
    TALUS_CHECK(!name.empty() && name.find_first_of(" \t\"(),/:;<=>?@[\\]{}\x7F") == std::string_view::npos);
    TALUS_CHECK(value.find_first_of("\r\n") == std::string_view::npos);
    if (equal_ignoring_case(name, "host")) ++hosts;
  }
  TALUS_CHECK(hosts <= 1 && (hosts == 1 || request->is_http_1_0));
  TALUS_CHECK(!(request->field("content-length") && request->field("transfer-encoding")));
  return 0;
}
