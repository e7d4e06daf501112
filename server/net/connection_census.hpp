// How many connections there are, in all and from each address. Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "server/schedule/fair_queue.hpp"

namespace talus::server {

/// An IPv6 address, or an IPv4 address mapped into it. Hosts of one IPv6 network share its first 64 bits.
using PeerAddress = std::array<unsigned char, 16>;

/// Whose share of the pool a peer's requests over HTTP take: all of an address take one.
ClientId client_of_address(const PeerAddress& address);

class ConnectionCensus {
 public:
  /// One counted connection; uncounted when it is destroyed. Must not outlive its census.
  class Place {
   public:
    Place() = default;
    Place(ConnectionCensus* census, const PeerAddress& address) : census_(census), address_(address) {}
    Place(Place&& other) noexcept : census_(std::exchange(other.census_, nullptr)), address_(other.address_) {}
    Place& operator=(Place&& other) noexcept {
      std::swap(census_, other.census_);
      std::swap(address_, other.address_);
      return *this;
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place() {
      if (census_ != nullptr) census_->leave(address_);
    }

   private:
    ConnectionCensus* census_ = nullptr;
    PeerAddress address_{};
  };

  enum class Verdict : std::uint8_t { kWelcome, kTooMany, kTooManyFromAddress };
  /// Counts the connection unless that makes more than `all_max`, or more than `address_max` of its address.
  std::pair<Verdict, Place> enter(const PeerAddress& address, std::size_t all_max, std::size_t address_max);
  std::size_t connections() const;

 private:
  struct AddressHash {
    std::size_t operator()(const PeerAddress& address) const noexcept;
  };
  void leave(const PeerAddress& address);

  mutable std::mutex mutex_;
  std::size_t all_ = 0;
  std::unordered_map<PeerAddress, std::size_t, AddressHash> by_address_;
};

}  // namespace talus::server
