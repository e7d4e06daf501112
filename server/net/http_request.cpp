#include "server/net/http_request.hpp"

#include <http_parser.h>

#include <algorithm>
#include <charconv>

#include "server/net/url_text.hpp"

namespace talus::server {

namespace {

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
constexpr HttpFault kLargeBody{413, "body_too_large", "the body is too large"};

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_token(std::string_view text) {
  constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  const auto is_token_char = [&](char c) {
    const char l = lower(c);
    return (l >= 'a' && l <= 'z') || (c >= '0' && c <= '9') || kMarks.find(c) != std::string_view::npos;
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), is_token_char);
}

/// The first of [from, to) that is a control character but a tab, or `to`.
std::size_t end_of_text(std::string_view bytes, std::size_t from, std::size_t to) {
  const auto is_text = [](char c) { return (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F) || c == '\t'; };
  while (from < to && is_text(bytes[from])) ++from;
  return from;
}

/// What http_parser reports about one head. A name or value may come in pieces, always of one stretch of bytes.
struct Reported {
  std::string_view url;
  HttpRequest* request = nullptr;
  bool is_in_value = true;
  bool is_complete = false;
};

void extend(std::string_view& view, const char* at, std::size_t length) {
  view = view.empty() ? std::string_view(at, length)
                      : std::string_view(view.data(), static_cast<std::size_t>(at + length - view.data()));
}

Reported& reported(http_parser* parser) {
  return *static_cast<Reported*>(parser->data);
}

int on_url(http_parser* parser, const char* at, std::size_t length) {
  extend(reported(parser).url, at, length);
  return 0;
}

int on_header_field(http_parser* parser, const char* at, std::size_t length) {
  Reported& r = reported(parser);
  if (r.is_in_value) {
    if (r.request->field_count == HttpRequest::kFieldsMax) return 1;
    r.request->fields[r.request->field_count++] = {};
    r.is_in_value = false;
  }
  extend(r.request->fields[r.request->field_count - 1].name, at, length);
  return 0;
}

int on_header_value(http_parser* parser, const char* at, std::size_t length) {
  Reported& r = reported(parser);
  r.is_in_value = true;
  extend(r.request->fields[r.request->field_count - 1].value, at, length);
  return 0;
}

int on_headers_complete(http_parser* parser) {
  reported(parser).is_complete = true;
  return 0;
}

const http_parser_settings& settings() {
  static const http_parser_settings kSettings = [] {
    http_parser_settings s;
    http_parser_settings_init(&s);
    s.on_url = on_url;
    s.on_header_field = on_header_field;
    s.on_header_value = on_header_value;
    s.on_headers_complete = on_headers_complete;
    return s;
  }();
  return kSettings;
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
    if (slash == std::string_view::npos) return false;
    target.remove_prefix(slash);
  }
  if (target == "*") return out.method == HttpMethod::kOptions;
  if (target.empty() || target.front() != '/' || target.find('#') != std::string_view::npos) return false;
  const std::size_t mark = target.find('?');
  out.path = target.substr(0, mark);
  if (mark != std::string_view::npos) out.query = target.substr(mark + 1);
  return true;
}

/// Fields that decide where a request ends and whom it is for: each has one reading or the request has none.
std::optional<HttpFault> check_fields(HttpRequest& request, unsigned minor, const NetLimits& limits) {
  std::size_t hosts = 0;
  std::optional<std::uint64_t> length;
  bool has_coding = false;
  for (std::size_t i = 0; i < request.field_count; ++i) {
    const HttpField& field = request.fields[i];
    if (!is_token(field.name)) return kFieldName;
    if (equal_ignoring_case(field.name, "host")) {
      // Of host and port nothing else can be part; what another server would make of it is not known.
      if (field.value.find_first_of(" \t/?#@\\\"") != std::string_view::npos) return kHost;
      ++hosts;
    }
    if (equal_ignoring_case(field.name, "transfer-encoding")) has_coding = true;
    if (!equal_ignoring_case(field.name, "content-length")) continue;
    std::uint64_t value = 0;
    const char* end = field.value.data() + field.value.size();
    const auto [at, error] = std::from_chars(field.value.data(), end, value);
    if (error != std::errc{} || at != end || length) return kLengths;
    length = value;
  }
  if (hosts > 1 || (hosts == 0 && minor == 1)) return kHost;
  if (length && has_coding) return kBothLengths;
  if (length && *length > limits.body_bytes) return kLargeBody;
  request.has_body = has_coding || length.value_or(0) > 0;
  return std::nullopt;
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::expected<std::optional<std::size_t>, HttpFault> HeadScanner::scan(std::string_view bytes) {
  for (; scanned_ < bytes.size(); ++scanned_) {
    const std::size_t limit =
        request_line_end_ == 0 ? limits_->request_line_bytes : request_line_end_ + limits_->head_bytes;
    // Nearly all of a head is text inside a line, of which nothing but its length is of interest.
    if (scanned_ != line_start_ && bytes[scanned_ - 1] != '\r') {
      scanned_ = end_of_text(bytes, scanned_, std::min(bytes.size(), limit));
      if (scanned_ == bytes.size()) break;
    }
    const char c = bytes[scanned_];
    if (scanned_ >= limit) return std::unexpected(request_line_end_ == 0 ? kLongLine : kLongHead);
    const bool follows_cr = scanned_ > 0 && bytes[scanned_ - 1] == '\r';
    if ((c == '\n') != follows_cr) return std::unexpected(kBareLine);
    const bool is_line_start = scanned_ == line_start_;
    if (is_line_start && request_line_end_ != 0 && (c == ' ' || c == '\t')) return std::unexpected(kFolded);
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\t' && c != '\r' && c != '\n') || byte == 0x7F) return std::unexpected(kControl);
    if (c != '\n') continue;
    const bool is_empty_line = scanned_ == line_start_ + 1;
    line_start_ = scanned_ + 1;
    if (is_empty_line && request_line_end_ == 0) return std::unexpected(kGrammar);
    if (is_empty_line) return ++scanned_;
    if (request_line_end_ == 0) {
      request_line_end_ = line_start_;
    } else if (++fields_ > std::min(limits_->head_fields, HttpRequest::kFieldsMax)) {
      return std::unexpected(kManyFields);
    }
  }
  return std::nullopt;
}

std::optional<std::string_view> HttpRequest::field(std::string_view name) const {
  for (std::size_t i = 0; i < field_count; ++i) {
    if (equal_ignoring_case(fields[i].name, name)) return fields[i].value;
  }
  return std::nullopt;
}

bool HttpRequest::lists(std::string_view name, std::string_view token) const {
  for (std::size_t i = 0; i < field_count; ++i) {
    if (!equal_ignoring_case(fields[i].name, name)) continue;
    std::string_view rest = fields[i].value;
    while (!rest.empty()) {
      const std::size_t comma = rest.find(',');
      if (equal_ignoring_case(trimmed(rest.substr(0, comma)), token)) return true;
      rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
    }
  }
  return false;
}

std::optional<HttpFault> parse_head_into(std::string_view head, const NetLimits& limits, HttpRequest& request) {
  Reported report;
  report.request = &request;
  http_parser parser;
  http_parser_init(&parser, HTTP_REQUEST);
  // Both present is refused below with a reason of its own.
  parser.allow_chunked_length = 1;
  parser.data = &report;
  const std::size_t taken = http_parser_execute(&parser, &settings(), head.data(), head.size());
  // An upgrade ends the parser's work on the last byte of the head; a declared body lies behind it.
  if (!report.is_complete || HTTP_PARSER_ERRNO(&parser) != HPE_OK || (taken != head.size() && parser.upgrade == 0)) {
    return kGrammar;
  }
  // The parser forgives runs of spaces; what another server sees there may be another target.
  const std::string_view line = head.substr(0, head.find('\r'));
  if (std::count(line.begin(), line.end(), ' ') != 2) return kGrammar;
  if (parser.http_major != 1 || parser.http_minor > 1) return kVersion;
  request.method = method_of(parser.method);
  request.is_http_1_0 = parser.http_minor == 0;
  request.is_keep_alive =
      parser.http_minor == 1 ? !request.lists("connection", "close") : request.lists("connection", "keep-alive");
  for (std::size_t i = 0; i < request.field_count; ++i) {
    request.fields[i].value = trimmed(request.fields[i].value);
  }
  if (const auto fault = check_fields(request, parser.http_minor, limits)) return fault;
  if (!split_target(report.url, request)) return kTarget;
  return std::nullopt;
}

std::expected<HttpRequest, HttpFault> parse_head(std::string_view head, const NetLimits& limits) {
  HttpRequest request;
  if (const auto fault = parse_head_into(head, limits, request)) return std::unexpected(*fault);
  return request;
}

}  // namespace talus::server
