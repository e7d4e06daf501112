// Small meshes for codec tests; no world needed.
#pragma once

#include "core/mesh/chunk_mesh.hpp"

namespace talus::protocol {

/// A closed height field over the whole chunk, every vertex on the lattice; `seed` moves its waves.
ChunkMesh sample_surface(int cells, unsigned seed);

/// Three tetrahedra: two that share an edge, and one that shares only a vertex with both.
ChunkMesh sample_pinched_tetrahedra();

}  // namespace talus::protocol
