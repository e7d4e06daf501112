#include "server/net/endpoint.hpp"

#include <asio/ip/address.hpp>

#include "server/net/url_text.hpp"

namespace talus::server {

std::expected<Endpoint, std::string> parse_endpoint(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  const std::string fault = "expected ADDRESS:PORT, such as 127.0.0.1:8080 or [::1]:0";
  if (colon == std::string_view::npos) return std::unexpected(fault);
  const auto port = whole_number(text.substr(colon + 1));
  std::string_view address = text.substr(0, colon);
  if (address.starts_with('[') && address.ends_with(']')) address = address.substr(1, address.size() - 2);
  asio::error_code error;
  asio::ip::make_address(address, error);
  if (error || !port || *port < 0 || *port > 65'535) return std::unexpected(fault);
  return Endpoint{std::string(address), static_cast<std::uint16_t>(*port)};
}

}  // namespace talus::server
