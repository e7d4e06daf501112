// Payloads as they came, an even sample of all, to be compared with the world function itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/grid/chunk_key.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "core/world/manifest.hpp"

namespace talus::load {

class Samples {
 public:
  Samples(std::size_t size, std::uint64_t seed) : size_(size), random_(seed) {}

  /// Every chunk that comes; each is kept with the same chance (J. Vitter, "Random sampling with a reservoir", 1985).
  void offer(const ChunkKey& key, ChunkKind kind, std::span<const std::byte> payload);
  std::size_t size() const { return kept_.size(); }
  const ChunkKey& key(std::size_t at) const { return kept_[at].key; }

  /// Evaluates every kept chunk of the world here. A sentence for each that differs.
  std::vector<std::string> compare(const Manifest& manifest) const;

 private:
  struct Kept {
    ChunkKey key;
    ChunkKind kind{};
    std::vector<std::byte> payload;
  };
  std::size_t size_;
  std::mt19937_64 random_;
  std::uint64_t offered_ = 0;
  std::vector<Kept> kept_;
};

}  // namespace talus::load
