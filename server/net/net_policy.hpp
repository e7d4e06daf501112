// What an operator may change while the server runs: limits, certificates, keys, who is trusted. One immutable value,
// replaced whole.
//
// A connection lives under the policy it was accepted with, so nothing it has checked once changes under it.
#pragma once

#include <atomic>
#include <cstdint>
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
    version_.fetch_add(1, std::memory_order_release);
  }
  /// Makes `known` the newest if it is not: `version` is of `known`, 0 for none. A look costs no lock.
  void refresh(PolicyRef& known, std::uint64_t& version) const {
    if (version_.load(std::memory_order_acquire) == version) return;
    const std::lock_guard lock(mutex_);
    known = policy_;
    version = version_.load(std::memory_order_relaxed);
  }

 private:
  mutable std::mutex mutex_;
  PolicyRef policy_;
  std::atomic<std::uint64_t> version_{1};  ///< changes under mutex_
};

}  // namespace talus::server
