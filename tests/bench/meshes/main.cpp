// Tables of what meshes are like and of what may carry them: `build/bench/bin/talus_mesh_bench [FOLDER]`. With a folder
// it keeps the payloads of LOD 0 there for `node tests/bench/meshes/decode.mjs FOLDER`.
#include "tests/bench/meshes/carrier_table.hpp"
#include "tests/bench/meshes/shape_table.hpp"
#include "tests/bench/meshes/strip_table.hpp"

int main(int count, char** arguments) {
  using namespace talus;
  const WorldFunction world{Manifest()};
  const std::string folder = count > 1 ? arguments[1] : "";
  for (const int lod : {0, 3, 6}) {
    const bench::TerrainSample chunks = bench::chunks_of_lod(world, lod, 32);
    bench::print_shapes(chunks);
    bench::print_carriers(chunks, lod == 0 ? folder : "");
  }
  const bench::TerrainSample coast = bench::view_from(world, "cliff coast, a view of 2 km", 67499.0, -30379.0, 2000.0);
  bench::print_shapes(coast);
  bench::print_carriers(coast, "");
  bench::print_strips(world, coast);
  return 0;
}
