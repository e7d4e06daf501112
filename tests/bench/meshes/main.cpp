// Tables of what meshes are like and what carries them: `build/bench/bin/talus_mesh_bench`.
#include "tests/bench/meshes/shape_table.hpp"

int main() {
  using namespace talus;
  const WorldFunction world{Manifest()};
  for (const int lod : {0, 3, 6}) bench::print_shapes(bench::chunks_of_lod(world, lod, 32));
  bench::print_shapes(bench::view_from(world, "cliff coast, a view of 2 km", 67499.0, -30379.0, 2000.0));
  return 0;
}
