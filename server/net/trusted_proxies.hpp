// Whose word is taken on where a request comes from. Immutable; any thread.
#pragma once

#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/net/connection_census.hpp"
#include "server/net/http_request.hpp"

namespace talus::server {

/// An address of a peer, IPv4 mapped into IPv6, whole.
using WholeAddress = std::array<unsigned char, 16>;
/// What peers are counted by: of IPv6 the network's first 64 bits.
PeerAddress counted_address(const WholeAddress& whole);

class TrustedProxies {
 public:
  /// Addresses and networks: "10.0.0.7", "10.0.0.0/8", "fd00::/8". The error names the text.
  static std::expected<TrustedProxies, std::string> parse(std::span<const std::string> texts);

  bool contains(const WholeAddress& address) const;
  /// Who is behind a trusted proxy at `peer`: the last address of X-Forwarded-For that is no proxy of ours. What stands
  /// before it was written by that peer and proves nothing. `peer` itself when the field is absent or unreadable.
  WholeAddress client_of(const WholeAddress& peer, const HttpRequest& request) const;

 private:
  struct Network {
    WholeAddress base{};
    unsigned bits = 128;
  };
  std::vector<Network> networks_;
};

}  // namespace talus::server
