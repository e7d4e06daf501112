// Meshes of terrain to measure codecs and shapes with: the same ones in every run.
#pragma once

#include <string>
#include <vector>

#include "core/grid/chunk_face.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "core/world/world_function.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::bench {

struct SampleMesh {
  ChunkMesh mesh;
  protocol::MeshLattice lattice;
  int lod = 0;
  bool is_strip = false;
};

struct TerrainSample {
  std::string name;
  double area_km2 = 0.0;  ///< of ground that a view shows; 0 for chunks of one LOD
  std::vector<SampleMesh> meshes;
  std::vector<StripKey> strips;  ///< of a view: those that have a triangle
};

/// `count` mountain chunks of one LOD (surface_chunks).
TerrainSample chunks_of_lod(const WorldFunction& world, int lod, int count);

/// What a viewer 60 m above the ground at (x, z) is sent: every chunk with a surface within `far_m`, and the strips
/// between them.
TerrainSample view_from(const WorldFunction& world, std::string name, double x_m, double z_m, double far_m);

}  // namespace talus::bench
