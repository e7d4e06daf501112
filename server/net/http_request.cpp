#include "server/net/http_request.hpp"

#include <http_parser.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

#include "server/net/url_text.hpp"

namespace talus::server {

namespace {

constexpr std::string_view kLineEnd = "\r\n";

constexpr HttpFault kBareLine{400, "malformed_request", "lines must end in CR LF"};
constexpr HttpFault kFolded{400, "malformed_request", "a header line starts with white space"};
constexpr HttpFault kControl{400, "malformed_request", "a control character in the head"};
constexpr HttpFault kLongLine{414, "request_line_too_long", "the request line is too long"};
constexpr HttpFault kLongHead{431, "head_too_large", "the header fields are too large"};
constexpr HttpFault kManyFields{431, "head_too_large", "too many header fields"};
constexpr HttpFault kGrammar{400, "malformed_request", "not an HTTP/1.1 request"};
constexpr HttpFault kVersion{400, "malformed_request", "the version must be HTTP/1.1 or HTTP/1.0"};
constexpr HttpFault kFieldName{400, "malformed_request", "a header name is not a token directly before its colon"};
constexpr HttpFault kHost{400, "malformed_request", "exactly one Host field is needed, of a host and perhaps a port"};
constexpr HttpFault kTarget{400, "malformed_request", "the request target is not a path"};
constexpr HttpFault kLengths{400, "malformed_request", "Content-Length is not one whole number"};
constexpr HttpFault kBothLengths{400, "malformed_request", "Content-Length and Transfer-Encoding together"};
constexpr HttpFault kCoding{400, "malformed_request", "Transfer-Encoding does not end in chunked"};
constexpr HttpFault kLargeBody{413, "body_too_large", "the body is too large"};

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// What a byte may be part of.
enum CharKind : std::uint8_t { kTokenChar = 1, kHostChar = 2, kTargetChar = 4 };

constexpr std::array<std::uint8_t, 256> kCharKinds = [] {
  constexpr std::string_view kTokenMarks = "!#$%&'*+-.^_`|~";
  // RFC 3986, 3.2.2 and 3.2.3, without a user; what another server would make of anything else is not known.
  constexpr std::string_view kHostMarks = "-._~%!$&'()*+,;=:[]";
  std::array<std::uint8_t, 256> kinds{};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const char c = static_cast<char>(i);
    const bool is_letter_or_digit = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool is_token = is_letter_or_digit || kTokenMarks.find(c) != std::string_view::npos;
    const bool is_host = is_letter_or_digit || kHostMarks.find(c) != std::string_view::npos;
    const bool is_target = i > 0x20 && i < 0x7F && c != '#';
    kinds[i] = static_cast<std::uint8_t>((is_token ? kTokenChar : 0) | (is_host ? kHostChar : 0) |
                                         (is_target ? kTargetChar : 0));
  }
  return kinds;
}();

bool is_all(CharKind kind, std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [kind](char c) { return (kCharKinds[static_cast<unsigned char>(c)] & kind) != 0; });
}

// Eight bytes at a time. A result has the highest bit of each byte that is meant; of the bytes behind the first one
// perhaps too. Based on: S. E. Anderson, "Bit Twiddling Hacks", hasless and haszero.

constexpr std::uint64_t kEach = 0x0101010101010101;
constexpr std::size_t kEight = sizeof(kEach);
static_assert(std::endian::native == std::endian::little, "the first byte is the lowest");

/// `limit` is at most 0x80.
constexpr std::uint64_t below(std::uint64_t bytes, std::uint64_t limit) {
  return (bytes - kEach * limit) & ~bytes & (kEach * 0x80);
}

constexpr std::uint64_t equal(std::uint64_t bytes, char c) {
  return below(bytes ^ (kEach * static_cast<unsigned char>(c)), 1);
}

std::uint64_t load_eight(const char* at) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, at, kEight);
  return eight;
}

/// The first of [from, to) that is a control character but a tab, or `to`.
std::size_t end_of_text(std::string_view bytes, std::size_t from, std::size_t to) {
  const auto is_text = [](char c) { return (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F) || c == '\t'; };
  while (from + kEight <= to) {
    const std::uint64_t eight = load_eight(bytes.data() + from);
    const std::uint64_t found = below(eight, 0x20) | equal(eight, 0x7F);
    from += found == 0 ? kEight : static_cast<std::size_t>(std::countr_zero(found)) / 8;
    if (found == 0) continue;
    if (!is_text(bytes[from])) return from;
    ++from;
  }
  while (from < to && is_text(bytes[from])) ++from;
  return from;
}

HttpMethod method_of(unsigned method) {
  switch (method) {
    case HTTP_GET:
      return HttpMethod::kGet;
    case HTTP_HEAD:
      return HttpMethod::kHead;
    case HTTP_OPTIONS:
      return HttpMethod::kOptions;
    default:
      return HttpMethod::kOther;
  }
}

/// Splits a target in origin form, absolute form or `*` (which becomes an empty path).
bool split_target(std::string_view target, HttpRequest& out) {
  constexpr std::string_view kScheme = "http://";
  if (target.size() > kScheme.size() && equal_ignoring_case(target.substr(0, kScheme.size()), kScheme)) {
    const std::size_t slash = target.find('/', kScheme.size());
    if (slash == std::string_view::npos || slash == kScheme.size()) return false;
    if (!is_all(kHostChar, target.substr(kScheme.size(), slash - kScheme.size()))) return false;
    target.remove_prefix(slash);
  }
  if (target == "*") return out.method == HttpMethod::kOptions;
  if (target.empty() || target.front() != '/' || !is_all(kTargetChar, target)) return false;
  const std::size_t mark = target.find('?');
  out.path = target.substr(0, mark);
  if (mark != std::string_view::npos) out.query = target.substr(mark + 1);
  return true;
}

/// Whether a list of transfer codings ends in chunked, without which nobody knows where the body does.
bool ends_chunked(std::string_view codings) {
  const std::size_t comma = codings.rfind(',');
  return equal_ignoring_case(trimmed(comma == std::string_view::npos ? codings : codings.substr(comma + 1)), "chunked");
}

/// Fields that decide where a request ends and whom it is for: each has one reading or the request has none.
std::optional<HttpFault> check_fields(HttpRequest& request, const NetLimits& limits) {
  std::size_t hosts = 0;
  std::optional<std::uint64_t> length;
  std::optional<bool> is_chunked;
  for (const HttpField& field : request.fields) {
    if (!is_all(kTokenChar, field.name)) return kFieldName;
    if (equal_ignoring_case(field.name, "host")) {
      if (!is_all(kHostChar, field.value)) return kHost;
      ++hosts;
    }
    if (equal_ignoring_case(field.name, "transfer-encoding")) is_chunked = ends_chunked(field.value);
    if (!equal_ignoring_case(field.name, "content-length")) continue;
    std::uint64_t value = 0;
    const char* end = field.value.data() + field.value.size();
    const auto [at, error] = std::from_chars(field.value.data(), end, value);
    if (error != std::errc{} || at != end || length) return kLengths;
    length = value;
  }
  if (hosts > 1 || (hosts == 0 && !request.is_http_1_0)) return kHost;
  if (length && is_chunked) return kBothLengths;
  if (is_chunked && !*is_chunked) return kCoding;
  if (length && *length > limits.body_bytes) return kLargeBody;
  request.has_body = is_chunked || length.value_or(0) > 0;
  return std::nullopt;
}

/// What http_parser tells of one head. A name, a value or the target may come in pieces, always of one stretch of
/// bytes.
struct Told {
  HttpRequest& request;
  std::string_view target;
  HttpField field;
  bool is_complete = false;

  static Told& by(http_parser* parser) { return *static_cast<Told*>(parser->data); }
  static void extend(std::string_view& view, const char* at, std::size_t size) {
    if (view.empty()) view = {at, size};
    view = {view.data(), static_cast<std::size_t>(at + size - view.data())};
  }
  /// False without room for it.
  bool end_field() {
    if (field.name.empty()) return true;
    if (request.fields.size() == HttpFields::kMax) return false;
    request.fields.push({field.name, trimmed(field.value)});
    field = {};
    return true;
  }
};

const http_parser_settings& head_callbacks() {
  static const http_parser_settings kCallbacks = [] {
    http_parser_settings callbacks;
    http_parser_settings_init(&callbacks);
    callbacks.on_url = [](http_parser* p, const char* at, std::size_t size) {
      Told::extend(Told::by(p).target, at, size);
      return 0;
    };
    callbacks.on_header_field = [](http_parser* p, const char* at, std::size_t size) {
      Told& told = Told::by(p);
      if (told.field.value.data() != nullptr && !told.end_field()) return 1;
      Told::extend(told.field.name, at, size);
      return 0;
    };
    callbacks.on_header_value = [](http_parser* p, const char* at, std::size_t size) {
      Told::extend(Told::by(p).field.value, at, size);
      return 0;
    };
    callbacks.on_headers_complete = [](http_parser* p) {
      Told::by(p).is_complete = Told::by(p).end_field();
      return 0;
    };
    return callbacks;
  }();
  return kCallbacks;
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::expected<std::optional<std::size_t>, HttpFault> HeadScanner::scan(std::string_view bytes) {
  for (;;) {
    const bool is_request_line = request_line_end_ == 0;
    const std::size_t limit = is_request_line ? limits_->request_line_bytes : request_line_end_ + limits_->head_bytes;
    const std::size_t end = std::min(bytes.size(), limit);
    const auto is_too_long = [&] { return std::unexpected(is_request_line ? kLongLine : kLongHead); };
    if (!is_request_line && line_start_ < end && (bytes[line_start_] == ' ' || bytes[line_start_] == '\t')) {
      return std::unexpected(kFolded);
    }
    scanned_ = end_of_text(bytes, scanned_, end);
    if (scanned_ == bytes.size()) return std::nullopt;
    if (scanned_ == limit) return is_too_long();
    if (bytes[scanned_] != '\r') return std::unexpected(bytes[scanned_] == '\n' ? kBareLine : kControl);
    if (scanned_ + 1 == bytes.size()) return std::nullopt;
    if (scanned_ + 1 == limit) return is_too_long();
    if (bytes[scanned_ + 1] != '\n') return std::unexpected(kBareLine);
    const bool is_empty = scanned_ == line_start_;
    scanned_ += kLineEnd.size();
    line_start_ = scanned_;
    if (is_empty && is_request_line) return std::unexpected(kGrammar);
    if (is_empty) return scanned_;
    if (is_request_line) {
      request_line_end_ = line_start_;
    } else if (++fields_ > std::min(limits_->head_fields, HttpFields::kMax)) {
      return std::unexpected(kManyFields);
    }
  }
}

std::optional<std::string_view> HttpRequest::field(std::string_view name) const {
  for (const HttpField& field : fields) {
    if (equal_ignoring_case(field.name, name)) return field.value;
  }
  return std::nullopt;
}

bool HttpRequest::lists(std::string_view name, std::string_view token) const {
  for (const HttpField& field : fields) {
    if (!equal_ignoring_case(field.name, name)) continue;
    std::string_view rest = field.value;
    while (!rest.empty()) {
      const std::size_t comma = rest.find(',');
      if (equal_ignoring_case(trimmed(rest.substr(0, comma)), token)) return true;
      rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
    }
  }
  return false;
}

std::optional<HttpFault> parse_head_into(std::string_view head, const NetLimits& limits, HttpRequest& request) {
  Told told{request, {}, {}};
  http_parser parser;
  http_parser_init(&parser, HTTP_REQUEST);
  parser.allow_chunked_length = 1;  // refused below, with a reason of its own
  parser.data = &told;
  const std::size_t taken = http_parser_execute(&parser, &head_callbacks(), head.data(), head.size());
  // An upgrade ends the parser's work on the last byte of the head; a declared body lies behind it.
  if (!told.is_complete || HTTP_PARSER_ERRNO(&parser) != HPE_OK || (taken != head.size() && parser.upgrade == 0)) {
    return kGrammar;
  }
  // It forgives runs of spaces, behind which another server may see another target.
  const std::string_view line = head.substr(0, head.find('\r'));
  if (std::ranges::count(line, ' ') != 2) return kGrammar;
  if (parser.http_major != 1 || parser.http_minor > 1) return kVersion;
  request.method = method_of(parser.method);
  request.is_http_1_0 = parser.http_minor == 0;
  request.is_keep_alive =
      request.is_http_1_0 ? request.lists("connection", "keep-alive") : !request.lists("connection", "close");
  if (const auto fault = check_fields(request, limits)) return fault;
  if (!split_target(told.target, request)) return kTarget;
  return std::nullopt;
}

std::expected<HttpRequest, HttpFault> parse_head(std::string_view head, const NetLimits& limits) {
  HttpRequest request;
  if (const auto fault = parse_head_into(head, limits, request)) return std::unexpected(*fault);
  return request;
}

}  // namespace talus::server
