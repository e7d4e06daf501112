#include "server/world/stored_chunks.hpp"

#include <fmt/format.h>

#include <utility>

namespace talus::server {

/// Nothing for what is not kept: a glb can be asked for against any origin, so their number has no bound.
std::optional<std::string> StoredChunks::disk_name(const PayloadName& name) const {
  if (disk_ == nullptr || name.origin != glm::dvec3{}) return std::nullopt;
  const World& world = *worlds_[name.world];
  return fmt::format("{} {} {} {}/{}/{}/{}", world.hash(), kGeneratorVersion, world.etag(name.format), name.key.lod,
                     name.key.x, name.key.y, name.key.z);
}

std::optional<ChunkPayload> StoredChunks::load(const PayloadName& name, std::size_t thread) {
  const auto named = disk_name(name);
  if (!named) return std::nullopt;
  auto loaded = disk_->load(*named, thread);
  if (!loaded || loaded->kind > static_cast<std::uint8_t>(ChunkKind::kMesh)) return std::nullopt;
  return ChunkPayload{static_cast<ChunkKind>(loaded->kind), std::move(loaded->bytes)};
}

void StoredChunks::store(const PayloadName& name, const PayloadRef& payload) {
  if (const auto named = disk_name(name)) {
    disk_->store(*named, static_cast<std::uint8_t>(payload->kind), StoredBytes(payload, &payload->bytes));
  }
}

void StoredChunks::flush() {
  if (disk_ != nullptr) disk_->flush();
}

}  // namespace talus::server
