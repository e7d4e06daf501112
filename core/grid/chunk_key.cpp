#include "core/grid/chunk_key.hpp"

#include "core/base/hash.hpp"

namespace talus {

std::size_t ChunkKeyHash::operator()(const ChunkKey& key) const noexcept {
  const auto pair = [](std::int32_t a, std::int32_t b) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32) | static_cast<std::uint32_t>(b);
  };
  return static_cast<std::size_t>(mix64(pair(key.lod, key.x), pair(key.y, key.z)));
}

}  // namespace talus
