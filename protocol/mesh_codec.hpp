// Chunk meshes and seam strips as Draco, chunk meshes as glTF binary. SPEC.md sections "Draco payload" and "glTF". No
// Draco type leaves this file's source.
#pragma once

#include <cstddef>
#include <expected>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/grid/chunk_key.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "protocol/codec_error.hpp"

namespace talus::protocol {

/// The lattice a payload's vertices lie on.
struct MeshLattice {
  int cells = 32;                 ///< per chunk edge
  double step_m = 0.0;            ///< voxel_m * 2^lod / kStepsPerCell; a power of two
  std::size_t triangles_max = 0;  ///< what a decoder takes at most
};
MeshLattice mesh_lattice(const ChunkKey& key, int cells, double voxel_m);
/// Of the seam strips of `key`: that of the next finer LOD, from the lowest corner of `key`. Requires key.lod > 0.
MeshLattice strip_lattice(const ChunkKey& key, int cells, double voxel_m);

/// Draco's own speed, 0..10, of every payload: 8 and above predict by differences, which on a lattice is smaller *and*
/// quicker than the parallelograms of 5..7.
inline constexpr int kDracoSpeed = 10;

/// A Draco mesh: POSITION (float32 x 3, chunk-local metres, explicit quantisation), NORMAL (float32 x 3, octahedral
/// kNormalBits), GENERIC unique id 2 (material, uint8) and GENERIC unique id 3 (ridge, uint8). Deterministic. kEmpty
/// without triangles. Other speeds are for comparing.
std::expected<std::vector<std::byte>, CodecError> encode_draco(const ChunkMesh& mesh, const MeshLattice& lattice,
                                                               int speed = kDracoSpeed);

/// Inverse of encode_draco up to the order of vertices and triangles; positions come back exactly, normals octahedrally
/// rounded. Safe on any bytes; at most `kOutboundMessageBytesMax` of them.
std::expected<ChunkMesh, CodecError> decode_draco(std::span<const std::byte> bytes, const MeshLattice& lattice);

/// One mesh of a glTF asset, and where its lowest corner stands.
struct GlbPart {
  const ChunkMesh& mesh;
  MeshLattice lattice;
  glm::dvec3 translation_m{};
};

/// glTF 2.0 binary with KHR_draco_mesh_compression required: POSITION, NORMAL, COLOR_0, _MATERIAL, _RIDGE; a node for
/// each part that has triangles, with `key` in its extras. Without any it is a valid asset with an empty scene.
std::expected<std::vector<std::byte>, CodecError> encode_glb(std::span<const GlbPart> parts, const ChunkKey& key);
/// The same of one chunk, counted from `origin_m`.
std::expected<std::vector<std::byte>, CodecError> encode_chunk_glb(const ChunkMesh& mesh, const ChunkKey& key,
                                                                   int cells, double voxel_m,
                                                                   const glm::dvec3& origin_m);

}  // namespace talus::protocol
