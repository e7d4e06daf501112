#include "server/net/stream_admission.hpp"

#include <limits>
#include <optional>
#include <utility>

#include "core/base/check.hpp"
#include "server/net/http_request.hpp"
#include "server/net/websocket_handshake.hpp"

namespace talus::server {

namespace {

/// Whose page asks, and how many streams its address has. Behind a proxy a stream counts for the one who is served.
std::optional<HttpAnswer> refuse_stream(NetContext& net, ConnectionPass& pass, const HttpRequest& request) {
  const NetPolicy& policy = *pass.policy;
  if (!policy.origins.admits(request.field("origin"))) {
    net.metrics.add(Count::kOriginRefused);
    return error_answer(403, "origin_not_allowed", "Origin: pages of this origin may not stream from here");
  }
  if (!pass.is_proxy) return std::nullopt;
  const PeerAddress address = counted_address(policy.proxies.client_of(pass.address, request));
  auto [verdict, place] =
      net.census.enter(address, std::numeric_limits<std::size_t>::max(), policy.limits.connections_per_address);
  if (verdict == ConnectionCensus::Verdict::kWelcome) {
    pass.place = std::move(place);
    return std::nullopt;
  }
  net.metrics.add(Count::kConnectionsRefusedAddress);
  return error_answer(429, "connections_per_address", "too many streams of your address");
}

}  // namespace

std::expected<std::string, HttpAnswer> stream_handshake(NetContext& net, ConnectionPass& pass, std::string_view head,
                                                        std::string_view request_id) {
  HttpRequest request;
  TALUS_CHECK(!parse_head_into(head, pass.policy->limits, request));
  auto handshake = websocket_handshake(request);
  if (!handshake) return handshake;
  if (auto refusal = refuse_stream(net, pass, request)) return std::unexpected(std::move(*refusal));
  handshake->insert(handshake->size() - 2, "X-Request-Id: " + std::string(request_id) + "\r\n");
  return handshake;
}

}  // namespace talus::server
