// HTTP answers out of bytes, one after another. No socket.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>

namespace talus::client {

/// Longest body taken: a chunk's is below 1 MiB, glb a little more.
inline constexpr std::size_t kHttpBodyBytesMax = 4 * 1024 * 1024;

struct HttpAnswer {
  unsigned status = 0;
  std::map<std::string, std::string> fields;  ///< names in lower case
  std::string body;
};

class HttpReader {
 public:
  enum class State {
    kMore,      ///< nothing is wrong and the answer is not whole
    kWhole,     ///< take it
    kTooLarge,  ///< fields or body beyond their bounds
    kBroken,    ///< not HTTP
  };

  HttpReader();
  ~HttpReader();
  HttpReader(const HttpReader&) = delete;
  HttpReader& operator=(const HttpReader&) = delete;

  /// None: the connection has ended, which ends bodies without a length. Bytes behind a whole answer are broken: nobody
  /// has asked for them.
  State feed(std::span<const char> bytes);
  /// The whole answer; the next one may begin.
  HttpAnswer take();
  /// Whether the connection of the last whole answer takes another request.
  bool is_kept_open() const;

 private:
  struct Parsing;
  std::unique_ptr<Parsing> parsing_;
};

}  // namespace talus::client
