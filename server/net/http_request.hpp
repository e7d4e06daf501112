// One HTTP/1.1 request head: found in the bytes of a connection, then parsed. Pure; views point into those bytes.
//
// llhttp reads it. Stricter than that, since smuggling lives on what is forgiven: bare line feeds, folded lines,
// runs of spaces, several hosts are refused too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string_view>

#include "server/net/limits.hpp"

namespace talus::server {

/// Why a request cannot be served at all. The connection closes after the answer: where the next request would start
/// is not known.
struct HttpFault {
  int status = 400;
  std::string_view code;     ///< for programs
  std::string_view message;  ///< for people
};

/// Finds the end of a head in bytes that come in pieces, each byte looked at once.
class HeadScanner {
 public:
  explicit HeadScanner(const NetLimits& limits) : limits_(&limits) {}

  /// `bytes` is everything from the first byte of the head on; what an earlier call has seen is not scanned again.
  /// The length of the head with its empty line, or nothing when it is not complete.
  std::expected<std::optional<std::size_t>, HttpFault> scan(std::string_view bytes);
  void reset() { *this = HeadScanner(*limits_); }

 private:
  const NetLimits* limits_;
  std::size_t scanned_ = 0;
  std::size_t line_start_ = 0;
  std::size_t request_line_end_ = 0;  ///< 0 while within the request line
  std::size_t fields_ = 0;
};

enum class HttpMethod : std::uint8_t { kGet, kHead, kOptions, kOther };

struct HttpField {
  std::string_view name;
  std::string_view value;
};

/// The fields of one head, in place: none is touched before it is there, since most of 64 never are.
class HttpFields {
 public:
  static constexpr std::size_t kMax = 64;

  HttpFields() {}  // not defaulted: that would clear the room wherever a request is made
  /// Requires room.
  void push(const HttpField& field) { at_.fields[count_++] = field; }
  const HttpField* begin() const { return at_.fields.data(); }
  const HttpField* end() const { return begin() + count_; }
  std::size_t size() const { return count_; }

 private:
  union Room {
    Room() {}
    std::array<HttpField, kMax> fields;
  };
  Room at_;
  std::size_t count_ = 0;
};

struct HttpRequest {
  HttpMethod method = HttpMethod::kOther;
  std::string_view path;   ///< from the first slash, without query, as sent
  std::string_view query;  ///< after '?', as sent
  bool is_keep_alive = false;
  bool is_http_1_0 = false;
  bool has_body = false;  ///< a length above zero, or a transfer coding
  HttpFields fields;

  /// The value of the first field of that name, letters in any case.
  std::optional<std::string_view> field(std::string_view name) const;
  /// Whether a comma-separated list field holds `token`, letters in any case.
  bool lists(std::string_view name, std::string_view token) const;
};

bool equal_ignoring_case(std::string_view a, std::string_view b);

/// `head` is what HeadScanner found, `out` a new request. Nothing, or why it cannot be served.
std::optional<HttpFault> parse_head_into(std::string_view head, const NetLimits& limits, HttpRequest& out);
/// The same for who does not mind 2 KiB being moved.
std::expected<HttpRequest, HttpFault> parse_head(std::string_view head, const NetLimits& limits);

}  // namespace talus::server
