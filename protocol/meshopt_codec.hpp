// Chunk meshes and seam strips by meshoptimizer's vertex and index codecs: quicker to encode and to decode than Draco,
// at more bytes. SPEC.md, "Mesh payload". No type of meshoptimizer leaves this file's source.
#pragma once

#include <cstddef>
#include <expected>
#include <span>
#include <vector>

#include "core/mesh/chunk_mesh.hpp"
#include "protocol/codec_error.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::protocol {

/// Triangles in an order that suits the small vertex caches of GPUs, vertices in the order of their first use; one that
/// no triangle has is left out. Deterministic. kEmpty without triangles. Requires what pack_vertex does.
std::expected<std::vector<std::byte>, CodecError> encode_meshopt(const ChunkMesh& mesh, const MeshLattice& lattice);

/// Inverse of encode_meshopt up to order; positions, materials and ridge map come back exactly, normals octahedrally
/// rounded. Safe on any bytes; at most `kOutboundMessageBytesMax` of them.
std::expected<ChunkMesh, CodecError> decode_meshopt(std::span<const std::byte> bytes, const MeshLattice& lattice);

/// A chunk's or a strip's surface in either format, by its first bytes.
std::expected<ChunkMesh, CodecError> decode_surface(std::span<const std::byte> bytes, const MeshLattice& lattice);

}  // namespace talus::protocol
