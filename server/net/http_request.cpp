#include "server/net/http_request.hpp"

#include <llhttp.h>

#include <algorithm>
#include <bit>
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
constexpr HttpFault kLength{400, "malformed_request", "Content-Length is not a whole number"};
constexpr HttpFault kLengths{400, "malformed_request", "several Content-Length, or one beside Transfer-Encoding"};
constexpr HttpFault kCoding{400, "malformed_request", "Transfer-Encoding does not end in chunked"};
constexpr HttpFault kLargeBody{413, "body_too_large", "the body is too large"};

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// RFC 3986, 3.2.2 and 3.2.3, without a user; what another server would make of anything else is not known.
constexpr std::array<bool, 256> kIsHostChar = [] {
  constexpr std::string_view kMarks = "-._~%!$&'()*+,;=:[]";
  std::array<bool, 256> is_host{};
  for (std::size_t i = 0; i < is_host.size(); ++i) {
    const char c = static_cast<char>(i);
    is_host[i] = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                 kMarks.find(c) != std::string_view::npos;
  }
  return is_host;
}();

bool is_host(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return kIsHostChar[static_cast<unsigned char>(c)]; });
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

/// Splits a target in origin form, absolute form or `*` (which becomes an empty path). llhttp lets printable ASCII
/// pass.
bool split_target(std::string_view target, HttpRequest& out) {
  constexpr std::string_view kScheme = "http://";
  if (target.size() > kScheme.size() && equal_ignoring_case(target.substr(0, kScheme.size()), kScheme)) {
    const std::size_t slash = target.find('/', kScheme.size());
    if (slash == std::string_view::npos || slash == kScheme.size()) return false;
    if (!is_host(target.substr(kScheme.size(), slash - kScheme.size()))) return false;
    target.remove_prefix(slash);
  }
  if (target == "*") return out.method == HttpMethod::kOptions;
  if (!target.starts_with('/') || target.contains('#')) return false;
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

/// Fields that decide where a request ends and whom it is for: each has one reading or the request has none. llhttp
/// knows most of it too, but takes an empty Transfer-Encoding for none.
std::optional<HttpFault> check_fields(HttpRequest& request, std::uint64_t body_bytes, const NetLimits& limits) {
  std::size_t hosts = 0;
  std::size_t lengths = 0;
  std::optional<bool> is_chunked;
  for (const HttpField& field : request.fields) {
    if (equal_ignoring_case(field.name, "host")) {
      if (!is_host(field.value)) return kHost;
      ++hosts;
    }
    if (equal_ignoring_case(field.name, "content-length")) ++lengths;
    if (equal_ignoring_case(field.name, "transfer-encoding")) is_chunked = ends_chunked(field.value);
  }
  if (hosts > 1 || (hosts == 0 && !request.is_http_1_0)) return kHost;
  if (lengths > (is_chunked ? 0U : 1U)) return kLengths;
  if (is_chunked && !*is_chunked) return kCoding;
  if (body_bytes > limits.body_bytes) return kLargeBody;
  request.has_body = is_chunked || body_bytes > 0;
  return std::nullopt;
}

/// What llhttp tells of one head. A name, a value or the target may come in pieces, always of one stretch of bytes.
struct Told {
  HttpRequest& request;
  std::string_view target;
  HttpField field;

  static Told& by(llhttp_t* parser) { return *static_cast<Told*>(parser->data); }
  static void extend(std::string_view& view, const char* at, std::size_t size) {
    if (view.empty()) view = {at, size};
    view = {view.data(), static_cast<std::size_t>(at + size - view.data())};
  }
};

const llhttp_settings_t& head_callbacks() {
  static const llhttp_settings_t kCallbacks = [] {
    llhttp_settings_t callbacks;
    llhttp_settings_init(&callbacks);
    callbacks.on_url = [](llhttp_t* p, const char* at, std::size_t size) {
      Told::extend(Told::by(p).target, at, size);
      return 0;
    };
    callbacks.on_header_field = [](llhttp_t* p, const char* at, std::size_t size) {
      Told::extend(Told::by(p).field.name, at, size);
      return 0;
    };
    callbacks.on_header_value = [](llhttp_t* p, const char* at, std::size_t size) {
      Told::extend(Told::by(p).field.value, at, size);
      return 0;
    };
    callbacks.on_header_value_complete = [](llhttp_t* p) {
      Told& told = Told::by(p);
      if (told.field.name.empty() || told.request.fields.size() == HttpFields::kMax) return int{HPE_USER};
      told.request.fields.push({told.field.name, trimmed(told.field.value)});
      told.field = {};
      return int{HPE_OK};
    };
    callbacks.on_headers_complete = [](llhttp_t*) { return int{HPE_PAUSED}; };
    return callbacks;
  }();
  return kCallbacks;
}

const HttpFault& fault_of(llhttp_errno_t error) {
  switch (error) {
    case HPE_INVALID_VERSION:
      return kVersion;
    case HPE_INVALID_HEADER_TOKEN:
    case HPE_CB_HEADER_VALUE_COMPLETE:  // ours, of a field without a name
      return kFieldName;
    case HPE_INVALID_CONTENT_LENGTH:
      return kLength;
    case HPE_UNEXPECTED_CONTENT_LENGTH:
      return kLengths;
    case HPE_INVALID_TRANSFER_ENCODING:
      return kCoding;
    default:
      return kGrammar;
  }
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return lower(x) == lower(y); });
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
  llhttp_t parser;
  llhttp_init(&parser, HTTP_REQUEST, &head_callbacks());
  parser.data = &told;
  const llhttp_errno_t error = llhttp_execute(&parser, head.data(), head.size());
  if (error != HPE_PAUSED) return fault_of(error);
  if (llhttp_get_error_pos(&parser) != head.data() + head.size()) return kGrammar;
  if (llhttp_get_http_major(&parser) != 1) return kVersion;
  // It forgives runs of spaces, behind which another server may see another target.
  constexpr std::string_view kBehindTarget = " HTTP/1.1\r\n";
  const auto target_at = static_cast<std::size_t>(told.target.data() - head.data());
  const auto line_bytes = target_at + told.target.size() + kBehindTarget.size();
  if (head[target_at - 2] == ' ' || head[line_bytes - 1] != '\n') return kGrammar;
  request.method = method_of(llhttp_get_method(&parser));
  request.is_http_1_0 = llhttp_get_http_minor(&parser) == 0;
  request.is_keep_alive = llhttp_should_keep_alive(&parser) != 0;
  if (const auto fault = check_fields(request, parser.content_length, limits)) return fault;
  if (!split_target(told.target, request)) return kTarget;
  return std::nullopt;
}

std::expected<HttpRequest, HttpFault> parse_head(std::string_view head, const NetLimits& limits) {
  HttpRequest request;
  if (const auto fault = parse_head_into(head, limits, request)) return std::unexpected(*fault);
  return request;
}

}  // namespace talus::server
