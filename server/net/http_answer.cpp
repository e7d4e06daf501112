#include "server/net/http_answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>

#include "core/base/check.hpp"
#include "server/observe/json.hpp"

namespace talus::server {

namespace {

std::string_view reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 304:
      return "Not Modified";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 426:
      return "Upgrade Required";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    default:
      return "Service Unavailable";
  }
}

/// Writes pieces of text one after the other into room that must be enough.
class Pen {
 public:
  explicit Pen(std::span<char> room) : at_(room.data()), end_(room.data() + room.size()) {}

  /// A literal, whose length the compiler knows.
  template <std::size_t N>
  void put(const char (&text)[N]) {
    need(N - 1);
    std::memcpy(at_, text, N - 1);
    at_ += N - 1;
  }
  void put(std::string_view text) {
    need(text.size());
    at_ = std::copy(text.begin(), text.end(), at_);
  }
  void put(std::size_t value) {
    need(kDigitsMax);
    at_ = std::to_chars(at_, end_, value).ptr;
  }
  /// One header line, or nothing when it has no value. `name` ends in ": ".
  template <std::size_t N>
  void put_field(const char (&name)[N], std::string_view value) {
    if (value.empty()) return;
    put(name);
    put(value);
    put("\r\n");
  }
  char* at() const { return at_; }

 private:
  static constexpr std::size_t kDigitsMax = 20;
  void need(std::size_t bytes) const { TALUS_CHECK(bytes <= static_cast<std::size_t>(end_ - at_)); }
  char* at_;
  char* const end_;
};

}  // namespace

std::span<const std::byte> HttpAnswer::body() const {
  if (payload != nullptr) return payload->bytes;
  if (file != nullptr) return file->bytes;
  return std::as_bytes(std::span(text));
}

HttpAnswer json_answer(std::string body) {
  HttpAnswer answer;
  answer.content_type = "application/json";
  answer.text = std::move(body);
  return answer;
}

HttpAnswer error_answer(int status, std::string_view code, std::string_view message, std::string_view fields) {
  HttpAnswer answer = json_answer("{\"error\":" + json_string(code) + ",\"message\":" + json_string(message) + "}");
  answer.status = status;
  answer.cache_control = "no-store";
  answer.fields = fields;
  return answer;
}

HttpAnswer unavailable_answer(double wait_s, std::string_view code, std::string_view message) {
  constexpr double kRetryMaxS = 60;
  HttpAnswer answer = error_answer(503, code, message);
  answer.retry_after_s = static_cast<int>(std::clamp(std::ceil(wait_s), 1.0, kRetryMaxS));
  return answer;
}

Count count_of(int status) {
  switch (status) {
    case 200:
      return Count::kHttpOk;
    case 204:
      return Count::kHttpNoContent;
    case 304:
      return Count::kHttpNotModified;
    default:
      return status >= 500 ? Count::kHttpServerError : Count::kHttpClientError;
  }
}

Count count_of_refusal(int status) {
  switch (status) {
    case 413:
      return Count::kBodyTooLarge;
    case 414:
      return Count::kUriTooLong;
    case 431:
      return Count::kHeadTooLarge;
    default:
      return Count::kBadRequest;
  }
}

HttpAnswer chunk_answer(PayloadRef payload, std::string_view etag, PayloadFormat format) {
  HttpAnswer answer;
  answer.etag = etag;
  answer.cache_control = kImmutable;
  if (payload->kind != ChunkKind::kMesh) {
    answer.status = 204;
    if (is_strip(format)) return answer;
    answer.fields = payload->kind == ChunkKind::kAir ? "Talus-Chunk: air\r\n" : "Talus-Chunk: rock\r\n";
    return answer;
  }
  if (format == PayloadFormat::kMap) {
    answer.content_type = "image/png";
    answer.payload = std::move(payload);
    return answer;
  }
  answer.content_type = has_origin(format) ? "model/gltf-binary" : "application/octet-stream";
  if (!is_strip(format)) answer.fields = "Talus-Chunk: mesh\r\n";
  answer.payload = std::move(payload);
  return answer;
}

HttpAnswer metrics_answer(const Metrics& metrics) {
  HttpAnswer answer;
  answer.content_type = "text/plain; version=0.0.4; charset=utf-8";
  answer.text = metrics.text();
  return answer;
}

HttpAnswer spawn_answer(const std::optional<glm::dvec3>& place) {
  if (!place) return error_answer(404, "no_land", "near: no dry land within about 130 km");
  HttpAnswer answer = json_answer(fmt::format(R"({{"x":{},"y":{},"z":{}}})", place->x, place->y, place->z));
  answer.cache_control = kNoCache;
  return answer;
}

void write_head(const HttpAnswer& answer, const HeadOptions& options, std::string& out) {
  // Room for all at once, then piece by piece: this is a good part of what a cached chunk costs.
  constexpr std::size_t kOwnTextMax = 512;  // literals, reason and numbers below come to 440
  const std::size_t room = kOwnTextMax + options.date.size() + answer.content_type.size() + answer.etag.size() +
                           answer.cache_control.size() + options.allow_origin.size() + options.request_id.size() +
                           answer.fields.size();
  out.resize_and_overwrite(room, [&](char* begin, std::size_t) {
    Pen pen({begin, room});
    pen.put("HTTP/1.1 ");
    pen.put(static_cast<std::size_t>(answer.status));
    pen.put(" ");
    pen.put(reason_of(answer.status));
    pen.put("\r\nDate: ");
    pen.put(options.date);
    pen.put("\r\nServer: talus\r\n");
    // A 204 or 304 has no body and, by RFC 9110, needs no length.
    if (answer.status != 204 && answer.status != 304) {
      pen.put_field("Content-Type: ", answer.content_type);
      pen.put("Content-Length: ");
      pen.put(answer.body().size());
      pen.put("\r\n");
    }
    pen.put_field("ETag: ", answer.etag);
    pen.put_field("Cache-Control: ", answer.cache_control);
    pen.put_field("Access-Control-Allow-Origin: ", options.allow_origin);
    if (options.varies_by_origin) pen.put("Vary: Origin\r\n");
    pen.put_field("X-Request-Id: ", options.request_id);
    pen.put(
        "Access-Control-Expose-Headers: ETag, Talus-Chunk, X-Request-Id\r\n"
        "X-Content-Type-Options: nosniff\r\n");
    if (answer.retry_after_s != 0) {
      pen.put("Retry-After: ");
      pen.put(static_cast<std::size_t>(answer.retry_after_s));
      pen.put("\r\n");
    }
    pen.put(answer.fields);
    if (!options.is_keep_alive) {
      pen.put("Connection: close\r\n");
    } else if (options.names_keep_alive) {
      pen.put("Connection: keep-alive\r\n");
    }
    pen.put("\r\n");
    return static_cast<std::size_t>(pen.at() - begin);
  });
}

std::string http_date(std::int64_t unix_seconds) {
  constexpr std::array<std::string_view, 7> kDays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr std::array<std::string_view, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::chrono::sys_seconds at{std::chrono::seconds(unix_seconds)};
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss time{at - day};
  return fmt::format("{}, {:02} {} {:04} {:02}:{:02}:{:02} GMT", kDays[std::chrono::weekday{day}.c_encoding()],
                     static_cast<unsigned>(date.day()), kMonths[static_cast<unsigned>(date.month()) - 1],
                     static_cast<int>(date.year()), time.hours().count(), time.minutes().count(),
                     time.seconds().count());
}

}  // namespace talus::server
