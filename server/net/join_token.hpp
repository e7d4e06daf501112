// Join tokens: who may read a world when the operator does not let everybody.
//
// A token is a JSON Web Token (RFC 7519) signed with HS256 and one of the operator's keys. It names its `world` and
// when it ends (`exp`); it may say when it begins (`nbf`). No other algorithm is taken, whatever a token says of
// itself. Immutable; any thread.
#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/observe/metrics.hpp"

namespace talus::server {

enum class TokenFault : std::uint8_t { kMissing, kBad, kExpired, kNotYet, kOtherWorld };

/// A sentence for the one who was refused.
std::string_view describe(TokenFault fault);
Count count_of(TokenFault fault);

class TokenKeys {
 public:
  /// One key a file, of protocol::kTokenKeyBytesMin to kTokenKeyBytesMax bytes, a newline at its end not counted. The
  /// error names the file.
  static std::expected<TokenKeys, std::string> load(std::span<const std::string> files);

  /// Without keys everybody may read.
  bool empty() const { return keys_.empty(); }
  /// Why `token` does not open `world` at `now_unix_s`; nothing if it does.
  std::optional<TokenFault> fault_of(std::string_view token, std::string_view world, std::int64_t now_unix_s) const;

 private:
  std::vector<std::string> keys_;
};

}  // namespace talus::server
