// Small meshes for codec tests; no world needed.
#pragma once

#include <array>
#include <vector>

#include "core/mesh/chunk_mesh.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::protocol {

/// That of a chunk of LOD 0.
inline const MeshLattice kUnit = mesh_lattice({0, 0, 0, 0}, 32, 1.0);

/// A closed height field over the whole chunk, every vertex on the lattice; `seed` moves its waves.
ChunkMesh sample_surface(int cells, unsigned seed);

/// Three tetrahedra: two that share an edge, and one that shares only a vertex with both.
ChunkMesh sample_pinched_tetrahedra();

/// A triangle as the corners it has, each by position, material and ridge map.
using Face = std::array<std::array<int, 5>, 3>;
/// Triangles turned so that the smallest corner comes first, in order: how vertices and triangles are numbered does not
/// matter, winding does.
std::vector<Face> faces_of(const ChunkMesh& mesh);

}  // namespace talus::protocol
