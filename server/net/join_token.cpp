#include "server/net/join_token.hpp"

#include <jwt.h>

#include <charconv>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "protocol/limits.hpp"

namespace talus::server {

namespace {

struct FreeJwt {
  void operator()(jwt_t* token) const { jwt_free(token); }
};
using Jwt = std::unique_ptr<jwt_t, FreeJwt>;

/// The token if `key` has signed it; nullptr otherwise.
Jwt opened(const std::string& token, const std::string& key) {
  jwt_t* raw = nullptr;
  const auto* bytes = reinterpret_cast<const unsigned char*>(key.data());
  if (jwt_decode(&raw, token.c_str(), bytes, static_cast<int>(key.size())) != 0) return nullptr;
  Jwt out(raw);
  return jwt_get_alg(raw) == JWT_ALG_HS256 ? std::move(out) : nullptr;
}

/// A claim that is a whole number, or `otherwise` when it is absent. Nothing when it is something else.
std::optional<std::int64_t> seconds_of(jwt_t* token, const char* claim, std::int64_t otherwise) {
  // As JSON: the library reads a number where there is a text or a fraction, too.
  const std::unique_ptr<char, void (*)(void*)> json(jwt_get_grants_json(token, claim), &std::free);
  if (json == nullptr) return otherwise;
  const std::string_view text(json.get());
  std::int64_t value = 0;
  const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && at == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

std::optional<TokenFault> fault_of_claims(jwt_t* token, std::string_view world, std::int64_t now_unix_s) {
  // A token without an end has ended.
  const auto ends = seconds_of(token, "exp", 0);
  const auto begins = seconds_of(token, "nbf", 0);
  if (!ends || !begins) return TokenFault::kBad;
  if (*ends <= now_unix_s) return TokenFault::kExpired;
  if (*begins > now_unix_s) return TokenFault::kNotYet;
  const char* named = jwt_get_grant(token, "world");
  if (named == nullptr || world != named) return TokenFault::kOtherWorld;
  return std::nullopt;
}

}  // namespace

std::string_view describe(TokenFault fault) {
  switch (fault) {
    case TokenFault::kMissing:
      return "token: this world is read with a token";
    case TokenFault::kBad:
      return "token: not signed with a key of this server, or its exp or nbf is no whole number";
    case TokenFault::kExpired:
      return "token: its time is over";
    case TokenFault::kNotYet:
      return "token: its time has not begun";
    case TokenFault::kOtherWorld:
      return "token: made for another world";
  }
  return "token: refused";
}

Count count_of(TokenFault fault) {
  switch (fault) {
    case TokenFault::kMissing:
      return Count::kTokenMissing;
    case TokenFault::kBad:
      return Count::kTokenBad;
    case TokenFault::kExpired:
      return Count::kTokenExpired;
    case TokenFault::kNotYet:
      return Count::kTokenNotYet;
    case TokenFault::kOtherWorld:
      return Count::kTokenOtherWorld;
  }
  return Count::kTokenBad;
}

std::expected<TokenKeys, std::string> TokenKeys::load(std::span<const std::string> files) {
  TokenKeys out;
  for (const std::string& file : files) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::unexpected(file + ": cannot be opened");
    std::string key(protocol::kTokenKeyBytesMax + 1, '\0');
    in.read(key.data(), static_cast<std::streamsize>(key.size()));
    key.resize(static_cast<std::size_t>(in.gcount()));
    while (key.ends_with('\n') || key.ends_with('\r')) key.pop_back();
    if (key.size() < protocol::kTokenKeyBytesMin || key.size() > protocol::kTokenKeyBytesMax) {
      return std::unexpected(file + ": a key has 32 to 4096 bytes; `talus token --make-key FILE` makes one");
    }
    out.keys_.push_back(std::move(key));
  }
  return out;
}

std::optional<TokenFault> TokenKeys::fault_of(std::string_view token, std::string_view world,
                                              std::int64_t now_unix_s) const {
  if (keys_.empty()) return std::nullopt;
  if (token.empty()) return TokenFault::kMissing;
  // A NUL would end the text for the library, and not for us.
  if (token.size() > protocol::kTokenBytesMax || token.find('\0') != std::string_view::npos) return TokenFault::kBad;
  const std::string text(token);
  for (const std::string& key : keys_) {
    if (const Jwt jwt = opened(text, key)) return fault_of_claims(jwt.get(), world, now_unix_s);
  }
  return TokenFault::kBad;
}

}  // namespace talus::server
