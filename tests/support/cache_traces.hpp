// Requests for chunks as servers see them, and the cache everybody knows, to measure ours by.
//
// Traces are what interest areas ask for along a flight: exactly what streaming viewers request, without a server.
// Sizes follow the world: one chunk in five holds a surface of about 7 KB, the rest are air or rock.
#pragma once

#include <cmath>
#include <cstdint>
#include <list>
#include <set>
#include <unordered_map>
#include <vector>

#include "protocol/interest_area.hpp"
#include "server/cache/memory_cache.hpp"
#include "tests/support/random.hpp"

namespace talus::test {

struct Asked {
  ChunkKey key;
  bool is_hot = true;  ///< false: a scanner's, asked for once and never again
};
using Trace = std::vector<Asked>;

inline std::size_t payload_bytes(const ChunkKey& key) {
  const std::uint64_t h = ChunkKeyHash()(key);
  return h % 5 == 0 ? 5000 + h / 5 % 4000 : 0;
}

struct Flight {
  double from_x = 0;
  double step_x = 0;
  double circle_m = 0;  ///< 0: straight
};

/// What a viewer asks for that makes `steps` steps: at each the chunks that are new in its view.
inline Trace flight(const Flight& path, int steps, double far_m) {
  const protocol::WorldShape shape{32, 1.0, {-200.0, 1800.0}};
  Trace out;
  std::set<ChunkKey> before;
  std::vector<ChunkKey> area;
  for (int i = 0; i < steps; ++i) {
    protocol::View view;
    const double turn = path.circle_m == 0 ? 0.0 : path.step_x * i / path.circle_m;
    view.position = {path.from_x + (path.circle_m == 0 ? path.step_x * i : path.circle_m * std::cos(turn)), 600.0,
                     path.circle_m * std::sin(turn)};
    view.far_m = far_m;
    protocol::interest_area(protocol::clamped(view, shape), shape, area);
    for (const ChunkKey& key : area) {
      if (!before.contains(key)) out.push_back({key, true});
    }
    before = {area.begin(), area.end()};
  }
  return out;
}

/// Of all traces in turn, one request each; after each round `scans` requests for chunks nobody else wants.
inline Trace interleaved(const std::vector<Trace>& traces, int scans) {
  Trace out;
  Random random(99);
  std::size_t longest = 0;
  for (const Trace& trace : traces) longest = std::max(longest, trace.size());
  for (std::size_t i = 0; i < longest; ++i) {
    for (const Trace& trace : traces) {
      if (i < trace.size()) out.push_back(trace[i]);
    }
    for (int s = 0; s < scans; ++s) {
      const auto far = [&] { return static_cast<std::int32_t>(random.whole(-1'000'000, 1'000'000)); };
      out.push_back({{0, far(), static_cast<std::int32_t>(random.whole(0, 50)), far()}, false});
    }
  }
  return out;
}

/// Bounded in bytes, the longest unused evicted first.
class LruCache {
 public:
  explicit LruCache(std::size_t bytes_max) : bytes_max_(bytes_max) {}
  /// Whether it was there; it is now.
  bool ask(const ChunkKey& key) {
    if (const auto found = places_.find(key); found != places_.end()) {
      order_.splice(order_.begin(), order_, found->second);
      return true;
    }
    order_.push_front(key);
    places_[key] = order_.begin();
    bytes_ += cost(key);
    while (bytes_ > bytes_max_) {
      bytes_ -= cost(order_.back());
      places_.erase(order_.back());
      order_.pop_back();
    }
    return false;
  }

 private:
  static std::size_t cost(const ChunkKey& key) { return payload_bytes(key) + server::kCacheEntryOverheadBytes; }
  const std::size_t bytes_max_;
  std::size_t bytes_ = 0;
  std::list<ChunkKey> order_;
  std::unordered_map<ChunkKey, std::list<ChunkKey>::iterator, ChunkKeyHash> places_;
};

/// Our cache, asked the same way.
class OurCache {
 public:
  explicit OurCache(std::size_t bytes_max) : cache_(bytes_max) {}
  bool ask(const ChunkKey& key) {
    server::PayloadName name;
    name.key = key;
    if (cache_.load(name) != nullptr) return true;
    cache_.store(name, std::make_shared<const server::ChunkPayload>(
                           server::ChunkPayload{ChunkKind::kMesh, std::vector<std::byte>(payload_bytes(key))}));
    return false;
  }

 private:
  server::MemoryCache cache_;
};

/// Share of the requests that are not a scanner's and were answered from memory, after the first third of the trace.
template <typename Cache>
double hot_hit_ratio(const Trace& trace, std::size_t bytes_max) {
  Cache cache(bytes_max);
  std::size_t asked = 0;
  std::size_t hit = 0;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const bool was_there = cache.ask(trace[i].key);
    if (!trace[i].is_hot || i < trace.size() / 3) continue;
    ++asked;
    hit += was_there ? 1 : 0;
  }
  return asked == 0 ? 0.0 : static_cast<double>(hit) / static_cast<double>(asked);
}

/// Twenty visits to one place, one after another, by viewers who go their own way from there.
inline std::vector<Trace> visits(int viewers, int steps) {
  std::vector<Trace> out;
  for (int v = 0; v < viewers; ++v) {
    Trace all;
    for (int visit = 0; visit < 4; ++visit) {
      const Trace one = flight({v * 3.0, 8.0 + v % 5, v % 2 == 0 ? 0.0 : 150.0 + 20.0 * v}, steps, 1000);
      all.insert(all.end(), one.begin(), one.end());
    }
    out.push_back(std::move(all));
  }
  return out;
}

}  // namespace talus::test
