#include "server/app/policy.hpp"

#include <memory>
#include <utility>

namespace talus::server {

std::expected<PolicyRef, std::string> make_policy(const Settings& settings) {
  auto policy = std::make_shared<NetPolicy>();
  policy->limits = settings.limits;
  if (!settings.tls_certificate.empty()) {
    auto tls = TlsContext::load(settings.tls_certificate, settings.tls_key);
    if (!tls) return std::unexpected("tls_certificate: " + tls.error() + "\n");
    policy->tls = std::move(*tls);
  }
  auto tokens = TokenKeys::load(settings.token_keys);
  if (!tokens) return std::unexpected("token_keys: " + tokens.error() + "\n");
  policy->tokens = std::move(*tokens);
  auto origins = AllowedOrigins::parse(settings.allowed_origins);
  if (!origins) return std::unexpected("allowed_origins: " + origins.error() + "\n");
  policy->origins = std::move(*origins);
  auto proxies = TrustedProxies::parse(settings.trusted_proxies);
  if (!proxies) return std::unexpected("trusted_proxies: " + proxies.error() + "\n");
  policy->proxies = std::move(*proxies);
  return policy;
}

}  // namespace talus::server
