#include "server/schedule/fair_queue.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/check.hpp"

namespace talus::server {

namespace {

/// What a lane lends, in seconds of work: a place to stand on is worth some thirty chunks of a view. The background
/// comes after a quarter of a second of everybody else's, so it goes on, slowly, on a server that is never idle.
constexpr std::array<double, kLanes> kLentS{0.050, 0.0, -0.010, -0.250};

/// What one overtaking by the same client is worth. Urgencies are distances in chunk edges, 0 to about 100: a job at
/// the far end comes first after 100 / 0.25 = 400 overtakings.
constexpr double kUrgencyPerOvertaking = 0.25;

/// No prediction is free or endless: a virtual time must advance, and one wrong prediction must not banish a client.
constexpr double kCostMinS = 1e-6;
constexpr double kCostMaxS = 1.0;

/// Clients that have nothing queued are remembered only while they are ahead of the others.
constexpr std::size_t kIdleClientsMax = 1024;

std::size_t index_of(Lane lane) {
  return static_cast<std::size_t>(lane);
}

double bounded(double cost_s) {
  return std::clamp(cost_s, kCostMinS, kCostMaxS);
}

}  // namespace

FairQueue::Client& FairQueue::enter(ClientId id) {
  if (clients_.size() > kIdleClientsMax && !clients_.contains(id)) forget_idle_clients();
  Client& client = clients_[id];
  if (client.queued == 0) client.virtual_s = std::max(client.virtual_s, now_s_);
  return client;
}

void FairQueue::add(ItemRef item, ClientId id) {
  Client& client = enter(id);
  item->claims.push_back(id);
  auto& list = client.items[index_of(item->lane)];
  list.push_back({std::move(item), client.served});
  ++client.queued;
}

FairQueue::Pushed FairQueue::push(ItemRef item, ClientId client, Lane lane) {
  Pushed pushed;
  if (const auto found = clients_.find(client); found != clients_.end() && found->second.queued >= client_items_max_) {
    pushed.is_over_share = true;
    return pushed;
  }
  if (size(lane) >= lane_items_max_) {
    pushed.displaced = take_from_greediest(lane, client);
    if (pushed.displaced == nullptr) return pushed;
  }
  item->lane = lane;
  item->cost_s = bounded(item->cost_s);
  item->arrival = ++arrivals_;
  ++lane_sizes_[index_of(lane)];
  ++items_;
  cost_s_ += item->cost_s;
  add(std::move(item), client);
  pushed.is_queued = true;
  return pushed;
}

void FairQueue::claim(const ItemRef& item, ClientId client) {
  if (item->claims.empty() || std::ranges::find(item->claims, client) != item->claims.end()) return;
  add(item, client);
}

void FairQueue::unclaim(const ItemRef& item, ClientId client) {
  const auto mine = std::ranges::find(item->claims, client);
  if (mine == item->claims.end()) return;
  TALUS_CHECK(item->claims.size() > 1);
  item->claims.erase(mine);
  erase(clients_.at(client), item);
}

void FairQueue::move(const ItemRef& item, Lane lane) {
  if (item->claims.empty() || item->lane == lane) return;
  const std::vector<ClientId> claims = std::move(item->claims);
  for (const ClientId id : claims) erase(clients_.at(id), item);
  item->claims.clear();
  --lane_sizes_[index_of(item->lane)];
  ++lane_sizes_[index_of(lane)];
  item->lane = lane;
  for (const ClientId id : claims) add(item, id);
}

void FairQueue::erase(Client& client, const ItemRef& item) {
  auto& list = client.items[index_of(item->lane)];
  list.erase(
      std::ranges::find(list, item, &Claimed::item));  // keeps the order of arrival, which decides between equals
  --client.queued;
}

void FairQueue::detach(const ItemRef& item) {
  for (const ClientId id : item->claims) erase(clients_.at(id), item);
  item->claims.clear();
  --lane_sizes_[index_of(item->lane)];
  // A sum of many small numbers that were added and taken away: nothing queued is nothing, not a rest.
  cost_s_ = --items_ == 0 ? 0.0 : cost_s_ - item->cost_s;
}

bool FairQueue::remove(const ItemRef& item) {
  if (item->claims.empty()) return false;
  detach(item);
  return true;
}

bool FairQueue::Candidate::is_before(const Candidate& other) const {
  if (virtual_s != other.virtual_s) return virtual_s < other.virtual_s;
  if (urgency != other.urgency) return urgency < other.urgency;
  return item->arrival < other.item->arrival;
}

/// Of the first lane that holds anything, the most urgent. Requires something queued.
FairQueue::Candidate FairQueue::candidate(ClientId id, Client& client) {
  std::size_t lane = 0;
  while (client.items[lane].empty()) ++lane;
  Candidate best{&client, id, nullptr, client.virtual_s - kLentS[lane], 0.0};
  for (const Claimed& claimed : client.items[lane]) {
    const auto overtaken = static_cast<double>(client.served - claimed.served_before);
    const double urgency = claimed.item->urgency.load(std::memory_order_relaxed) - kUrgencyPerOvertaking * overtaken;
    if (best.item != nullptr && urgency >= best.urgency) continue;
    best.item = claimed.item;
    best.urgency = urgency;
  }
  return best;
}

FairQueue::ItemRef FairQueue::pop() {
  if (items_ == 0) return nullptr;
  Candidate best;
  double behind_s = std::numeric_limits<double>::infinity();
  for (auto& [id, client] : clients_) {
    if (client.queued == 0) continue;
    behind_s = std::min(behind_s, client.virtual_s);
    if (Candidate one = candidate(id, client); best.client == nullptr || one.is_before(best)) best = std::move(one);
  }
  now_s_ = std::max(now_s_, behind_s);
  best.client->virtual_s += best.item->cost_s;
  ++best.client->served;
  detach(best.item);
  best.item->served_for = best.id;
  return best.item;
}

/// The least urgent item of whoever has the most in the lane, if that is at least two more than `client` has: with one
/// more the two would only change places. What others have claimed as well stays.
FairQueue::ItemRef FairQueue::take_from_greediest(Lane lane, ClientId client) {
  const std::size_t at = index_of(lane);
  const auto mine = clients_.find(client);
  const std::size_t have = mine == clients_.end() ? 0 : mine->second.items[at].size();
  const Client* greediest = nullptr;
  for (const auto& [id, other] : clients_) {
    if (greediest == nullptr || other.items[at].size() > greediest->items[at].size()) greediest = &other;
  }
  if (greediest == nullptr || greediest->items[at].size() < have + 2) return nullptr;
  ItemRef last;
  for (const auto& [item, served_before] : greediest->items[at]) {
    if (item->claims.size() > 1) continue;
    if (last == nullptr ||
        item->urgency.load(std::memory_order_relaxed) >= last->urgency.load(std::memory_order_relaxed)) {
      last = item;
    }
  }
  if (last != nullptr) detach(last);
  return last;
}

std::vector<FairQueue::ItemRef> FairQueue::clear() {
  std::vector<ItemRef> all;
  for (auto& [id, client] : clients_) {
    for (auto& list : client.items) {
      for (Claimed& claimed : list) {
        if (!claimed.item->claims.empty()) all.push_back(claimed.item);
        claimed.item->claims.clear();
      }
    }
  }
  clients_.clear();
  lane_sizes_.fill(0);
  items_ = 0;
  cost_s_ = 0;
  return all;
}

void FairQueue::charge(ClientId client, double cost_s) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  found->second.virtual_s += std::clamp(cost_s, -kCostMaxS, kCostMaxS);
}

/// Those behind would start at the present anyway. If the rest are still too many, what they owe is forgiven.
void FairQueue::forget_idle_clients() {
  std::erase_if(clients_,
                [&](const auto& entry) { return entry.second.queued == 0 && entry.second.virtual_s <= now_s_; });
  if (clients_.size() <= kIdleClientsMax) return;
  std::erase_if(clients_, [](const auto& entry) { return entry.second.queued == 0; });
}

}  // namespace talus::server
