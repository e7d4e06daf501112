#include "client_sample/cli/flight.hpp"

#include <cmath>
#include <utility>

#include "client_sample/cli/text.hpp"
#include "protocol/meshopt_codec.hpp"

namespace talus::cli {

Flight::Flight(client::Loop& loop, client::StreamOptions options, bool decodes)
    : decodes_(decodes), stream_(loop, std::move(options), handlers()) {}

client::StreamHandlers Flight::handlers() {
  client::StreamHandlers out;
  out.on_welcome = [this](const client::WorldInfo&) { log_.welcome_s = seconds(); };
  out.on_view = [this](const protocol::ViewAccepted& accepted) { log_.wanted = accepted.chunks; };
  out.on_chunk = [this](const client::ArrivedChunk& chunk) { on_chunk(chunk); };
  out.on_strip = [this](const client::ArrivedStrip& strip) {
    log_.strips += strip.payload.empty() ? 0U : 1U;
    log_.strip_bytes += strip.payload.size();
  };
  out.on_leave = [this](const std::vector<ChunkKey>& keys) { log_.leaves += keys.size(); };
  out.on_idle = [this](const protocol::Idle& idle) {
    ++log_.idles;
    if (idle.view_sequence != 0 && !log_.complete_s) log_.complete_s = seconds();
  };
  out.on_closed = [this](const client::ClientError& error) {
    is_over_ = true;
    if (!log_.error) log_.error = error;
  };
  return out;
}

void Flight::look(const protocol::View& view) {
  view_ = view;
  sequence_ = stream_.look(view);
  ++log_.views;
}

bool Flight::is_under_viewer(const ChunkKey& key) const {
  const protocol::WorldShape& shape = stream_.info()->shape;
  const BoxWorld box = box_of(key, shape.cells, shape.voxel_m);
  return view_.position.x >= box.low.x && view_.position.x < box.high.x && view_.position.z >= box.low.z &&
         view_.position.z < box.high.z && box.low.y <= view_.position.y;
}

void Flight::on_chunk(const client::ArrivedChunk& chunk) {
  const protocol::ChunkHead& head = chunk.head;
  if (!log_.first_chunk_s) log_.first_chunk_s = seconds();
  if (head.kind != ChunkKind::kMesh) {
    ++log_.empties;
    return;
  }
  ++log_.meshes;
  log_.bytes += chunk.payload.size();
  if (!log_.first_ground_s && head.key.lod == 0 && is_under_viewer(head.key)) log_.first_ground_s = seconds();
  if (!decodes_) return;
  const protocol::WorldShape& shape = stream_.info()->shape;
  const auto mesh =
      protocol::decode_surface(chunk.payload, protocol::mesh_lattice(head.key, shape.cells, shape.voxel_m));
  if (mesh) {
    log_.triangles += mesh->triangles();
  } else if (!log_.error) {
    log_.error = client::ClientError{client::ErrorCode::kProtocol, "chunk " + format_chunk_key(head.key) + ": " +
                                                                       std::string(describe(mesh.error()))};
  }
}

}  // namespace talus::cli
