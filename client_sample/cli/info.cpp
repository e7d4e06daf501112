// talus info: what a server's world is.
#include <fmt/format.h>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/reach_server.hpp"
#include "client_sample/library/http_get.hpp"
#include "client_sample/library/world_info.hpp"

namespace talus::cli {

ExitCode info(const InfoOptions& options) {
  const auto server = reach_server(options.server);
  if (!server) return server.error();
  const auto answer = client::http_get(*server, "/v1/worlds/" + options.server.world);
  if (!answer) {
    fmt::print(stderr, "talus: {}; is talusd running? Start it with `talusd`, or name it with --server\n",
               answer.error().message);
    return kFailed;
  }
  if (answer->status != 200) {
    fmt::print(stderr, "talus: the server answered {}: {}\n", answer->status, client::error_text(answer->body));
    return kFailed;
  }
  const auto world = client::parse_world_info(answer->body);
  if (!world) {
    fmt::print(stderr, "talus: the answer is not the manifest of a world\n");
    return kFailed;
  }
  if (options.is_json) {
    fmt::print("{}\n", answer->body);
    return kDone;
  }
  const double edge = world->shape.cells * world->shape.voxel_m;
  fmt::print("world       {}\nseed        {}\nhash        {}\ngenerator   {}\n", world->name, world->seed,
             world->world_hash, world->generator_version);
  fmt::print("chunk       {} cells of {} m: {} m at LOD 0, {} m at LOD {}\n", world->shape.cells, world->shape.voxel_m,
             edge, edge * (1 << world->lod_max), world->lod_max);
  fmt::print("heights     {:.0f} to {:.0f} m, sea at {} m\n", world->shape.height_range_m.x,
             world->shape.height_range_m.y, world->sea_level_m);
  return kDone;
}

}  // namespace talus::cli
