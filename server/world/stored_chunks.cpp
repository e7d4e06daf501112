#include "server/world/stored_chunks.hpp"

#include <fmt/format.h>

#include <utility>

namespace talus::server {

namespace {

/// An entry's kind is the chunk's in two bits, and above them the six faces that its surface reaches.
constexpr unsigned kKindBits = 2;
constexpr unsigned kKindMask = (1U << kKindBits) - 1;
static_assert(kKindBits + kChunkFaces <= 8);

}  // namespace

/// Nothing for what is not kept: a glb can be asked for against any origin, so their number has no bound.
std::optional<std::string> StoredChunks::disk_name(const PayloadName& name) const {
  if (disk_ == nullptr || name.origin != glm::dvec3{}) return std::nullopt;
  const World& world = *worlds_[name.world];
  return fmt::format("{} {} {} {}/{}/{}/{} {}", world.hash(), generator_version_, world.etag(name), name.key.lod,
                     name.key.x, name.key.y, name.key.z, static_cast<unsigned>(name.face));
}

std::optional<ChunkPayload> StoredChunks::load(const PayloadName& name, std::size_t thread) {
  const auto named = disk_name(name);
  if (!named) return std::nullopt;
  auto loaded = disk_->load(*named, thread);
  if (!loaded) return std::nullopt;
  const unsigned kind = loaded->kind & kKindMask;
  if (kind > static_cast<unsigned>(ChunkKind::kMesh)) return std::nullopt;
  return ChunkPayload{static_cast<ChunkKind>(kind), std::move(loaded->bytes),
                      static_cast<std::uint8_t>(loaded->kind >> kKindBits)};
}

void StoredChunks::store(const PayloadName& name, const PayloadRef& payload, DiskCache::Commit commit) {
  const auto named = disk_name(name);
  if (!named) return;
  const unsigned kind = static_cast<unsigned>(payload->kind) | unsigned{payload->faces} << kKindBits;
  disk_->store(*named, static_cast<std::uint8_t>(kind), StoredBytes(payload, &payload->bytes), commit);
}

void StoredChunks::flush() {
  if (disk_ != nullptr) disk_->flush();
}

}  // namespace talus::server
