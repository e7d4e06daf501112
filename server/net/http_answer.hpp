// An HTTP answer as a value, and its head as bytes. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "server/cache/payload.hpp"
#include "server/net/static_files.hpp"
#include "server/observe/metrics.hpp"

namespace talus::server {

/// Views point to literals, a world or a file: all outlive the answer. A body is text, a payload or a file, never two.
struct HttpAnswer {
  int status = 200;
  std::string_view content_type;
  std::string_view etag;
  std::string_view cache_control;
  std::string_view fields;  ///< further header lines, each with its CR LF
  int retry_after_s = 0;    ///< when it is worth coming again; 0: not said
  bool is_fault = false;    ///< ours: the log tells of it
  std::string text;
  PayloadRef payload;
  StaticFileRef file;

  std::span<const std::byte> body() const;
};

inline constexpr std::string_view kImmutable = "public, max-age=31536000, immutable";
/// Where tokens open a world: for its reader's own cache, and for no shared one.
inline constexpr std::string_view kImmutablePrivate = "private, max-age=31536000, immutable";
inline constexpr std::string_view kNoCache = "no-cache";

HttpAnswer json_answer(std::string body);
/// `{"error": code, "message": message}`; `fields` must outlive the answer.
HttpAnswer error_answer(int status, std::string_view code, std::string_view message, std::string_view fields = {});

/// 503 that says when the queue, `wait_s` long, is expected to be done, so that coming again is worth it.
HttpAnswer unavailable_answer(double wait_s, std::string_view code, std::string_view message);
/// What an answer of this status counts as.
Count count_of(int status);
/// What a request counts as that was refused for its form, with this status.
Count count_of_refusal(int status);

/// 200 with the payload (a map tile always is one), or 204 and what fills the chunk (nothing for an empty strip); for
/// ever cacheable. `etag` must outlive the answer.
HttpAnswer chunk_answer(PayloadRef payload, std::string_view etag, PayloadFormat format);
/// All that is counted, as Prometheus reads it.
HttpAnswer metrics_answer(const Metrics& metrics);
/// The place as JSON, or 404.
HttpAnswer spawn_answer(const std::optional<glm::dvec3>& place);

struct HeadOptions {
  std::string_view date;  ///< IMF-fixdate
  bool is_keep_alive = true;
  bool names_keep_alive = false;        ///< HTTP/1.0 peers want to be told
  std::string_view allow_origin = "*";  ///< whose pages may read; empty: none
  bool varies_by_origin = false;        ///< a cache must not give it to another origin's pages
  std::string_view request_id = {};     ///< empty: not told
};
/// Replaces `out` by the head of `answer`; reuses its memory.
void write_head(const HttpAnswer& answer, const HeadOptions& options, std::string& out);

/// "Sun, 22 Nov 2026 22:47:31 GMT"
std::string http_date(std::int64_t unix_seconds);

}  // namespace talus::server
