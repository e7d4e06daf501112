#include "client_sample/library/server_address.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace talus::client {
namespace {

struct Scheme {
  std::string_view prefix;
  std::string_view port;  ///< when the URL names none
  Carrier carrier;
  bool is_secure;
};
constexpr std::array<Scheme, 6> kSchemes{{
    {"http://", "80", Carrier::kWebSocket, false},
    {"ws://", "80", Carrier::kWebSocket, false},
    {"https://", "443", Carrier::kWebSocket, true},
    {"wss://", "443", Carrier::kWebSocket, true},
    {"tcp://", "8081", Carrier::kTcp, false},
    {"tls://", "8081", Carrier::kTcp, true},
}};

std::unexpected<ClientError> unusable(std::string_view url, std::string_view why) {
  return std::unexpected(ClientError{
      ErrorCode::kUrl, "\"" + std::string(url) + "\" " + std::string(why) + "; give it as http://127.0.0.1:8080"});
}

bool is_printable(char c) {
  return c > ' ' && c < '\x7F';
}

}  // namespace

std::string_view name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUrl:
      return "url";
    case ErrorCode::kResolve:
      return "resolve";
    case ErrorCode::kConnect:
      return "connect";
    case ErrorCode::kTimeout:
      return "timeout";
    case ErrorCode::kHttp:
      return "http";
    case ErrorCode::kHandshake:
      return "handshake";
    case ErrorCode::kProtocol:
      return "protocol";
    case ErrorCode::kRefused:
      return "refused";
    case ErrorCode::kBye:
      return "bye";
  }
  return "unknown";
}

std::string ServerAddress::authority() const {
  const bool is_v6 = host.find(':') != std::string::npos;
  return (is_v6 ? '[' + host + ']' : host) + ':' + std::to_string(port);
}

std::expected<ServerAddress, ClientError> parse_server_url(std::string_view url) {
  const auto scheme = std::ranges::find_if(kSchemes, [&](const Scheme& one) { return url.starts_with(one.prefix); });
  if (scheme == kSchemes.end()) return unusable(url, "begins with none of http:// https:// tcp:// tls://");
  const bool is_tcp = scheme->carrier == Carrier::kTcp;
  if (!std::ranges::all_of(url, is_printable)) return unusable(url, "holds a blank or a control character");
  std::string_view rest = url.substr(scheme->prefix.size());
  if (rest.find_first_of("?#@") != std::string_view::npos) return unusable(url, "has a query, fragment or user");

  ServerAddress out;
  out.carrier = scheme->carrier;
  out.is_secure = scheme->is_secure;
  const std::size_t slash = rest.find('/');
  if (slash != std::string_view::npos) {
    out.prefix = rest.substr(slash);
    while (out.prefix.ends_with('/')) out.prefix.pop_back();
    if (is_tcp && !out.prefix.empty()) return unusable(url, "has a path, which tcp has not");
    rest = rest.substr(0, slash);
  }
  std::string_view port = scheme->port;
  const std::size_t bracket = rest.find(']');
  const std::size_t colon = rest.find(':', bracket == std::string_view::npos ? 0 : bracket);
  if (colon != std::string_view::npos) {
    port = rest.substr(colon + 1);
    rest = rest.substr(0, colon);
  }
  if (rest.starts_with('[') && rest.ends_with(']')) rest = rest.substr(1, rest.size() - 2);
  if (rest.empty()) return unusable(url, "names no host");
  out.host = rest;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), out.port);
  if (error != std::errc{} || end != port.data() + port.size() || out.port == 0) {
    return unusable(url, "has no port from 1 to 65535");
  }
  return out;
}

}  // namespace talus::client
