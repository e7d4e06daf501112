#include "server/net/connection_census.hpp"

#include <bit>

#include "core/base/hash.hpp"

namespace talus::server {

ClientId client_of_address(const PeerAddress& address) {
  const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(address);
  return mix64(halves[0], halves[1]) | 1U;  // odd: streams have even ones
}

std::size_t ConnectionCensus::AddressHash::operator()(const PeerAddress& address) const noexcept {
  return static_cast<std::size_t>(client_of_address(address));
}

std::pair<ConnectionCensus::Verdict, ConnectionCensus::Place> ConnectionCensus::enter(const PeerAddress& address,
                                                                                      std::size_t all_max,
                                                                                      std::size_t address_max) {
  const std::lock_guard lock(mutex_);
  if (all_ >= all_max) return {Verdict::kTooMany, Place{}};
  const auto here = by_address_.find(address);
  if (here != by_address_.end() && here->second >= address_max) return {Verdict::kTooManyFromAddress, Place{}};
  ++by_address_[address];
  ++all_;
  return {Verdict::kWelcome, Place{this, address}};
}

void ConnectionCensus::leave(const PeerAddress& address) {
  const std::lock_guard lock(mutex_);
  --all_;
  const auto found = by_address_.find(address);
  if (--found->second == 0) by_address_.erase(found);
}

std::size_t ConnectionCensus::connections() const {
  const std::lock_guard lock(mutex_);
  return all_;
}

}  // namespace talus::server
