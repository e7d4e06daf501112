// talus get: one chunk, from a server or evaluated here, into a file.
#include <expected>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "client_sample/cli/mesh_file.hpp"
#include "client_sample/cli/reach_server.hpp"
#include "client_sample/cli/text.hpp"
#include "client_sample/library/fetch_world.hpp"
#include "client_sample/library/http_get.hpp"
#include "client_sample/library/world_info.hpp"
#include "core/mesh/build_chunk.hpp"
#include "core/mesh/density_tile.hpp"
#include "core/mesh/height_tile.hpp"
#include "protocol/mesh_codec.hpp"
#include "protocol/meshopt_codec.hpp"
#include "protocol/tile_codec.hpp"

namespace talus::cli {
namespace {

using client::HttpAnswer;

/// What a server has ready; other formats are made here from a .drc.
const std::set<std::string_view> kServedExtensions{".drc", ".mesh", ".glb", ".density", ".height"};

std::string_view extension_of(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : path.substr(dot);
}

std::string_view text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

ExitCode no_surface(const ChunkKey& key, std::string_view kind) {
  fmt::print(stderr, "talus: chunk {} is all {}: there is no surface to write\n", format_chunk_key(key), kind);
  return kNoSurface;
}

ExitCode store(const GetOptions& options, std::string_view bytes) {
  if (!store_file(options.output, bytes)) return kFailed;
  if (options.output != "-") fmt::print(stderr, "{}: {} bytes\n", options.output, bytes.size());
  return kDone;
}

ExitCode store_encoded(const GetOptions& options,
                       const std::expected<std::vector<std::byte>, protocol::CodecError>& bytes) {
  if (bytes) return store(options, text_of(*bytes));
  fmt::print(stderr, "talus: {}\n", protocol::describe(bytes.error()));
  return kFailed;
}

/// Writes what is known as a mesh already.
ExitCode store_mesh(const GetOptions& options, const ChunkKey& key, const ChunkMesh& mesh, int cells, double voxel_m) {
  const protocol::MeshLattice lattice = protocol::mesh_lattice(key, cells, voxel_m);
  const glm::dvec3 corner = box_of(key, cells, voxel_m).low;
  const std::string_view extension = extension_of(options.output);
  if (extension == ".obj") return store(options, encode_obj(mesh, lattice, corner));
  if (extension == ".ply") return store(options, encode_ply(mesh, lattice, corner));
  if (extension == ".mesh") return store_encoded(options, protocol::encode_meshopt(mesh, lattice));
  return store_encoded(options, extension == ".glb" ? protocol::encode_chunk_glb(mesh, key, cells, voxel_m, {})
                                                    : protocol::encode_draco(mesh, lattice));
}

ExitCode get_local(const GetOptions& options, const ChunkKey& key) {
  const auto manifest = load_manifest(options.manifest);
  if (!manifest) return manifest.error();
  const WorldFunction world(*manifest);
  const std::string_view extension = extension_of(options.output);
  ChunkScratch scratch;
  if (extension == ".height" || extension == ".density") world.columns(chunk_columns(world, key), scratch.columns);
  if (extension == ".height") {
    HeightTile tile;
    sample_height_tile(world, scratch.columns, tile);
    return store_encoded(options, protocol::encode_height(tile, key));
  }
  if (extension == ".density") {
    DensityTile tile;
    const ChunkKind kind = sample_density_tile(world, key, scratch, tile);
    if (kind != ChunkKind::kMesh) return no_surface(key, kind == ChunkKind::kAir ? "air" : "rock");
    return store_encoded(options, protocol::encode_density(tile, key));
  }
  ChunkMesh mesh;
  const ChunkKind kind = build_chunk(world, key, scratch, mesh);
  if (kind != ChunkKind::kMesh) return no_surface(key, kind == ChunkKind::kAir ? "air" : "rock");
  return store_mesh(options, key, mesh, world.cells(), world.voxel_m());
}

/// An answer of 200 or 204; everything else has been said.
std::optional<HttpAnswer> fetch(const client::ServerAddress& server, const std::string& target) {
  auto answer = client::http_get(server, target);
  if (!answer) {
    fmt::print(stderr, "talus: {}\n", answer.error().message);
    return std::nullopt;
  }
  if (answer->status == 200 || answer->status == 204) return std::move(*answer);
  fmt::print(stderr, "talus: {} answered {}: {}\n", target, answer->status, client::error_text(answer->body));
  return std::nullopt;
}

ExitCode get_remote(const GetOptions& options, const ChunkKey& key) {
  const auto server = reach_server(options.server);
  if (!server) return server.error();
  const std::string world = "/v1/worlds/" + options.server.world;
  const std::string_view extension = extension_of(options.output);
  const bool is_stored_as_sent = kServedExtensions.contains(extension);
  const std::string target =
      extension == ".height"
          ? fmt::format("{}/columns/{}/{}/{}.height", world, key.lod, key.x, key.z)
          : fmt::format("{}/chunks/{}{}", world, format_chunk_key(key), is_stored_as_sent ? extension : ".drc");
  const auto answer = fetch(*server, target);
  if (!answer) return kFailed;
  if (answer->status == 204) {
    const auto kind = answer->fields.find("talus-chunk");
    return no_surface(key, kind == answer->fields.end() ? "air or rock" : kind->second);
  }
  if (is_stored_as_sent) return store(options, answer->body);

  const auto info = client::fetch_world(*server, options.server.world);
  if (!info) {
    fmt::print(stderr, "talus: {}\n", info.error());
    return kFailed;
  }
  const int cells = info->shape.cells;
  const double voxel_m = info->shape.voxel_m;
  const auto mesh =
      protocol::decode_draco(std::as_bytes(std::span(answer->body)), protocol::mesh_lattice(key, cells, voxel_m));
  if (mesh) return store_mesh(options, key, *mesh, cells, voxel_m);
  fmt::print(stderr, "talus: {}: {}\n", target, protocol::describe(mesh.error()));
  return kFailed;
}

}  // namespace

ExitCode get(const GetOptions& options) {
  const auto key = parse_chunk_key(options.key);
  if (!key) {
    fmt::print(
        stderr,
        "talus: \"{}\" is not a chunk: give LOD/X/Y/Z with LOD 0..{} and coordinates within +-{}, as 0/12/3/-7\n",
        options.key, kLodMax, kChunkLimit);
    return kUsage;
  }
  const std::string_view extension = extension_of(options.output);
  if (!kServedExtensions.contains(extension) && extension != ".obj" && extension != ".ply") {
    fmt::print(stderr,
               "talus: \"{}\" has to end in .drc, .mesh, .glb, .obj, .ply, .density or .height: that is the format\n",
               options.output);
    return kUsage;
  }
  return options.is_local ? get_local(options, *key) : get_remote(options, *key);
}

}  // namespace talus::cli
