// What an engine does with the installed package: evaluates a chunk itself, encodes and decodes it, and makes a stream.
#include <cstdio>

#include "client_sample/library/world_stream.hpp"
#include "core/mesh/build_chunk.hpp"
#include "protocol/mesh_codec.hpp"

int main() {
  using namespace talus;
  const WorldFunction world{Manifest()};
  ChunkScratch scratch;
  ChunkMesh mesh;
  for (std::int32_t y = -8; y <= 8; ++y) {
    const ChunkKey key{8, 0, y, 0};
    if (build_chunk(world, key, scratch, mesh) != ChunkKind::kMesh) continue;
    const auto lattice = protocol::mesh_lattice(key, world.cells(), world.voxel_m());
    const auto bytes = protocol::encode_draco(mesh, lattice);
    if (!bytes) return 1;
    const auto decoded = protocol::decode_draco(*bytes, lattice);
    if (!decoded || decoded->triangles() != mesh.triangles()) return 1;
    std::printf("%zu triangles in %zu bytes\n", mesh.triangles(), bytes->size());
    client::Loop loop;
    client::StreamOptions options;
    options.server = *client::parse_server_url("http://127.0.0.1:1");
    bool closed = false;
    client::StreamHandlers handlers;
    handlers.on_closed = [&](const client::ClientError&) { closed = true; };
    const client::WorldStream stream(loop, options, handlers);
    for (int i = 0; i < 100 && !closed; ++i) loop.run_for(std::chrono::milliseconds(50));
    return closed ? 0 : 2;
  }
  return 3;
}
