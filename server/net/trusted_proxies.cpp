#include "server/net/trusted_proxies.hpp"

#include <algorithm>
#include <asio/ip/address.hpp>
#include <optional>

#include "server/net/url_text.hpp"

namespace talus::server {

namespace {

constexpr unsigned kMappedBits = 96;  // in front of an IPv4 address

std::optional<asio::ip::address> parsed(std::string_view text) {
  asio::error_code error;
  const auto address = asio::ip::make_address(text, error);
  if (error) return std::nullopt;
  return address;
}

WholeAddress whole(const asio::ip::address& address) {
  if (address.is_v6()) return address.to_v6().to_bytes();
  return asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4()).to_bytes();
}

bool is_same(const WholeAddress& a, const WholeAddress& b, unsigned bits) {
  const std::size_t bytes = bits / 8;
  if (!std::equal(a.begin(), a.begin() + bytes, b.begin())) return false;
  const unsigned rest = bits % 8;
  return rest == 0 || (a[bytes] ^ b[bytes]) >> (8 - rest) == 0;
}

}  // namespace

PeerAddress counted_address(const WholeAddress& address) {
  constexpr WholeAddress kMapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 0, 0, 0, 0};
  PeerAddress out = address;
  if (!is_same(address, kMapped, kMappedBits)) std::fill(out.begin() + 8, out.end(), static_cast<unsigned char>(0));
  return out;
}

std::expected<TrustedProxies, std::string> TrustedProxies::parse(std::span<const std::string> texts) {
  TrustedProxies out;
  for (const std::string& text : texts) {
    const std::size_t slash = text.find('/');
    const auto address = parsed(std::string_view(text).substr(0, slash));
    const int bits_max = address && address->is_v6() ? 128 : 32;
    const auto bits = slash == std::string::npos ? std::optional<int>(bits_max)
                                                 : whole_number(std::string_view(text).substr(slash + 1));
    if (!address || !bits || *bits < 0 || *bits > bits_max) {
      return std::unexpected("'" + text + "': expected an address or a network, such as 10.0.0.7 or 10.0.0.0/8");
    }
    out.networks_.push_back({whole(*address), static_cast<unsigned>(*bits) + (address->is_v6() ? 0 : kMappedBits)});
  }
  return out;
}

bool TrustedProxies::contains(const WholeAddress& address) const {
  return std::any_of(networks_.begin(), networks_.end(),
                     [&](const Network& network) { return is_same(address, network.base, network.bits); });
}

WholeAddress TrustedProxies::client_of(const WholeAddress& peer, const HttpRequest& request) const {
  WholeAddress out = peer;
  for (const HttpField* at = request.fields.end(); at != request.fields.begin();) {
    const HttpField& field = *--at;
    if (!equal_ignoring_case(field.name, "x-forwarded-for")) continue;
    std::string_view rest = field.value;
    while (!rest.empty()) {
      const std::size_t comma = rest.rfind(',');
      const std::string_view last = comma == std::string_view::npos ? rest : rest.substr(comma + 1);
      rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(0, comma);
      const auto address = parsed(trimmed(last));
      if (!address) return out;
      out = whole(*address);
      if (!contains(out)) return out;
    }
  }
  return out;
}

}  // namespace talus::server
