// What an operator may change while the server runs: limits, certificates, keys, who is trusted. One immutable value,
// replaced whole.
//
// A connection lives under the policy it was accepted with, so nothing it has checked once changes under it.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "server/net/allowed_origins.hpp"
#include "server/net/join_token.hpp"
#include "server/net/limits.hpp"
#include "server/net/tls.hpp"
#include "server/net/trusted_proxies.hpp"

namespace talus::server {

struct NetPolicy {
  NetLimits limits;
  std::shared_ptr<const TlsContext> tls;  ///< of the listeners that speak TLS; nullptr when none does
  TokenKeys tokens;
  AllowedOrigins origins;
  TrustedProxies proxies;
};
using PolicyRef = std::shared_ptr<const NetPolicy>;

/// Any thread.
class PolicySlot {
 public:
  explicit PolicySlot(PolicyRef policy) : policy_(std::move(policy)) {}

  PolicyRef load() const {
    const std::lock_guard lock(mutex_);
    return policy_;
  }
  void store(PolicyRef policy) {
    const std::lock_guard lock(mutex_);
    policy_.swap(policy);
  }

 private:
  mutable std::mutex mutex_;
  PolicyRef policy_;
};

}  // namespace talus::server
