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
  return policy;
}

}  // namespace talus::server
