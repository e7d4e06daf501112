#include "core/base/check.hpp"
#include "server/net/http_request.hpp"
#include "server/net/url_text.hpp"
#include "tests/fuzz/fuzz_one.hpp"

#include <http_parser.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

/// A head as http_parser reads it, which many servers and proxies stand on.
struct SecondReading {
  std::string url;
  std::vector<std::pair<std::string, std::string>> fields;
  bool is_in_value = true;
  bool is_complete = false;

  explicit SecondReading(std::string_view head) {
    http_parser_settings settings;
    http_parser_settings_init(&settings);
    settings.on_url = [](http_parser* p, const char* at, std::size_t size) { return of(p).url.append(at, size), 0; };
    settings.on_header_field = [](http_parser* p, const char* at, std::size_t size) {
      SecondReading& r = of(p);
      if (std::exchange(r.is_in_value, false)) r.fields.emplace_back();
      r.fields.back().first.append(at, size);
      return 0;
    };
    settings.on_header_value = [](http_parser* p, const char* at, std::size_t size) {
      of(p).is_in_value = true;
      of(p).fields.back().second.append(at, size);
      return 0;
    };
    settings.on_headers_complete = [](http_parser* p) { return of(p).is_complete = true, 0; };
    http_parser parser;
    http_parser_init(&parser, HTTP_REQUEST);
    parser.lenient_http_headers = 1;  // codings of bodies, which it reads and we do not
    parser.allow_chunked_length = 1;
    parser.data = this;
    http_parser_execute(&parser, &settings, head.data(), head.size());
    is_complete = is_complete && HTTP_PARSER_ERRNO(&parser) == HPE_OK;
  }
  static SecondReading& of(http_parser* parser) { return *static_cast<SecondReading*>(parser->data); }
};

/// What is let in has one reading.
void check_second_reading(std::string_view head, const talus::server::HttpRequest& request) {
  const SecondReading second(head);
  TALUS_CHECK(second.is_complete);
  std::string target(request.path.empty() ? "*" : request.path);
  if (!request.query.empty()) target.append("?").append(request.query);
  TALUS_CHECK(second.url.ends_with(target) || second.url.ends_with(target + "?"));
  TALUS_CHECK(second.fields.size() == request.fields.size());
  for (std::size_t i = 0; const auto& [name, value] : request.fields) {
    TALUS_CHECK(second.fields[i].first == name);
    TALUS_CHECK(talus::server::trimmed(second.fields[i++].second) == value);
  }
}

}  // namespace

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
    TALUS_CHECK(value.find_first_of("\r\n") == std::string_view::npos);
    if (equal_ignoring_case(name, "host")) ++hosts;
  }
  TALUS_CHECK(hosts <= 1 && (hosts == 1 || request->is_http_1_0));
  TALUS_CHECK(!(request->field("content-length") && request->field("transfer-encoding")));
  check_second_reading(head, *request);
  return 0;
}
