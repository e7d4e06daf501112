// What runs next: fair between clients, by lane and then by present urgency for each. Not locked; its owner's threads
// take turns.
//
// Problem: one pool, and clients that ask for a hundred or for 10^5 things. Answer: each client has a virtual time,
// which advances by the predicted cost of what it is given; the client furthest behind is served next. One who comes
// new, or again, starts at the time of the one furthest behind, so waiting saves nothing up and asking for much delays
// only oneself. Lanes lend: a job under somebody's feet counts as if its client were further behind, one in the
// background as if it were ahead. What was lent is not given: over a while every client has its share, whatever lanes
// it uses.
//
// Based on: K. Duda, D. Cheriton, "Borrowed-Virtual-Time (BVT) scheduling", SOSP 1999; here clients instead of threads,
// lanes instead of warp parameters, and jobs that several clients may claim.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <unordered_map>
#include <vector>

namespace talus::server {

/// In order of precedence.
enum class Lane : std::uint8_t {
  kFeet,       ///< what a viewer stands on
  kView,       ///< what somebody looks at or has asked for
  kCover,      ///< coarse, far away, behind
  kBackground  ///< nobody waits for it
};
inline constexpr std::size_t kLanes = 4;

/// Whom a job is made for; equal ids share one share.
using ClientId = std::uint64_t;

class FairQueue {
 public:
  struct Item {
    std::atomic<double> urgency{0.0};  ///< smaller is sooner among one client's of a lane; any thread may move it
    double cost_s = 0.001;             ///< predicted

    /// Once popped: whose turn it was.
    ClientId client() const { return served_for; }

    virtual ~Item() = default;
    Item() = default;
    Item(const Item&) = delete;
    Item& operator=(const Item&) = delete;

   private:
    friend class FairQueue;
    std::vector<ClientId> claims;
    ClientId served_for = 0;
    Lane lane = Lane::kView;
    std::uint64_t arrival = 0;
  };
  using ItemRef = std::shared_ptr<Item>;

  explicit FairQueue(std::size_t lane_items_max, std::size_t client_items_max = std::numeric_limits<std::size_t>::max())
      : lane_items_max_(lane_items_max), client_items_max_(client_items_max) {}

  struct Pushed {
    bool is_queued = false;
    bool is_over_share = false;  ///< not queued, since the client has as much waiting as one may have
    ItemRef displaced;           ///< had to make room
  };
  /// When the lane is full, the client with the most in it loses its least urgent item, unless that client would be
  /// `client` itself.
  Pushed push(ItemRef item, ClientId client, Lane lane);
  /// One more client wants a queued item: it is served at whichever's turn comes first. Nothing if it is not queued.
  void claim(const ItemRef& item, ClientId client);
  /// A client wants it no more; the item stays for the others, and at least one must be left.
  void unclaim(const ItemRef& item, ClientId client);
  /// Nothing if it is not queued. A lane that is full takes it all the same: no item is new.
  void move(const ItemRef& item, Lane lane);
  /// False when it was not queued.
  bool remove(const ItemRef& item);
  /// Null when empty.
  ItemRef pop();
  /// Removes everything.
  std::vector<ItemRef> clear();

  /// A job turned out to cost this much more, or less, than was predicted.
  void charge(ClientId client, double cost_s);

  bool empty() const { return items_ == 0; }
  std::size_t size(Lane lane) const { return lane_sizes_[static_cast<std::size_t>(lane)]; }
  /// Predicted cost of all that is queued.
  double cost_s() const { return cost_s_; }
  std::size_t clients() const { return clients_.size(); }

 private:
  struct Claimed {
    ItemRef item;
    std::uint64_t served_before = 0;  ///< items of this client when it claimed this one: what has overtaken it since
  };
  struct Client {
    double virtual_s = 0;
    std::uint64_t served = 0;
    std::array<std::vector<Claimed>, kLanes> items;
    std::size_t queued = 0;
  };
  /// A client's next item, and what decides between it and others'.
  struct Candidate {
    Client* client = nullptr;
    ClientId id = 0;
    ItemRef item;
    double virtual_s = 0;
    double urgency = 0;

    bool is_before(const Candidate& other) const;
  };

  Client& enter(ClientId id);
  void add(ItemRef item, ClientId client);
  void detach(const ItemRef& item);
  static void erase(Client& client, const ItemRef& item);
  ItemRef take_from_greediest(Lane lane, ClientId client);
  static Candidate candidate(ClientId id, Client& client);
  void forget_idle_clients();

  const std::size_t lane_items_max_;
  const std::size_t client_items_max_;  ///< of one client, in all lanes
  std::unordered_map<ClientId, Client> clients_;
  std::array<std::size_t, kLanes> lane_sizes_{};
  std::size_t items_ = 0;
  double cost_s_ = 0;
  double now_s_ = 0;  ///< virtual time of the client furthest behind that had anything queued
  std::uint64_t arrivals_ = 0;
};

}  // namespace talus::server
