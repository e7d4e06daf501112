// A chunk as a file that other programs open. Pure: bytes only.
#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "core/mesh/chunk_mesh.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::cli {

/// Wavefront OBJ: positions in metres from `corner_m`, colours of materials behind them, normals.
std::string encode_obj(const ChunkMesh& mesh, const protocol::MeshLattice& lattice, const glm::dvec3& corner_m);

/// Binary little-endian PLY: double x y z, float normals, uchar red green blue material ridge.
std::string encode_ply(const ChunkMesh& mesh, const protocol::MeshLattice& lattice, const glm::dvec3& corner_m);

}  // namespace talus::cli
