// Encoding trusts its mesh; decoding trusts nothing: counts are bounded by the lattice before anything is allocated,
// and meshoptimizer's decoders, which are safe on any bytes, say nothing of indices and places: those are looked at
// after.
#include "protocol/meshopt_codec.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include <meshoptimizer.h>

#include "core/base/check.hpp"
#include "protocol/lattice_vertex.hpp"
#include "protocol/limits.hpp"
#include "protocol/tile_bytes.hpp"

namespace talus::protocol {
namespace {

constexpr std::uint32_t kMagic = 0x6D736C74;  // "tlsm"
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kHeaderBytes = 24;
/// Vertices of the smallest caches that are about, first in, first out. Ordering for such a cache is arithmetic of
/// whole numbers, so bytes do not depend on the machine; meshoptimizer's other orders add floats up.
constexpr unsigned kCacheVertices = 16;

const unsigned char* raw(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

/// Appends what `encode(begin, bytes_max)` writes; returns how many bytes that were, 0 where it failed.
template <class Encode>
std::size_t append(std::vector<std::byte>& out, std::size_t bytes_max, Encode encode) {
  const std::size_t before = out.size();
  out.resize(before + bytes_max);
  const std::size_t written = encode(reinterpret_cast<unsigned char*>(out.data() + before), bytes_max);
  out.resize(before + written);
  return written;
}

/// Versions of the codecs are settings of the whole process, and their defaults change with the library's release; the
/// bytes of a payload must not. Index codec 1 has fewer bytes than 0; vertex codec 0 is what every decoder reads.
void choose_versions() {
  static const bool kAreChosen = (meshopt_encodeIndexVersion(1), meshopt_encodeVertexVersion(0), true);
  (void)kAreChosen;
}

}  // namespace

std::expected<std::vector<std::byte>, CodecError> encode_meshopt(const ChunkMesh& mesh, const MeshLattice& lattice) {
  TALUS_CHECK(lattice.cells > 0 && lattice.cells <= kLatticeCellsMax);
  const std::size_t points = mesh.positions.size();
  TALUS_CHECK(mesh.normals.size() == points && mesh.materials.size() == points && mesh.ridges.size() == points);
  if (mesh.indices.empty()) return std::unexpected(CodecError::kEmpty);
  choose_versions();

  std::vector<unsigned> indices(mesh.indices.size());
  meshopt_optimizeVertexCacheFifo(indices.data(), mesh.indices.data(), indices.size(), points, kCacheVertices);
  std::vector<unsigned> place_of(points);
  const std::size_t used = meshopt_optimizeVertexFetchRemap(place_of.data(), indices.data(), indices.size(), points);
  meshopt_remapIndexBuffer(indices.data(), indices.data(), indices.size(), place_of.data());
  std::vector<LatticeVertex> vertices(used);
  for (std::size_t v = 0; v < points; ++v) {
    if (place_of[v] >= used) continue;  // no triangle has it
    vertices[place_of[v]] = pack_vertex(mesh.positions[v], mesh.normals[v], mesh.materials[v], mesh.ridges[v]);
  }

  std::vector<std::byte> coded;
  const std::size_t index_bytes =
      append(coded, meshopt_encodeIndexBufferBound(indices.size(), used), [&](unsigned char* to, std::size_t max) {
        return meshopt_encodeIndexBuffer(to, max, indices.data(), indices.size());
      });
  const std::size_t vertex_bytes = append(
      coded, meshopt_encodeVertexBufferBound(used, sizeof(LatticeVertex)), [&](unsigned char* to, std::size_t max) {
        return meshopt_encodeVertexBuffer(to, max, vertices.data(), used, sizeof(LatticeVertex));
      });
  if (index_bytes == 0 || vertex_bytes == 0) return std::unexpected(CodecError::kInternal);
  if (kHeaderBytes + coded.size() > kOutboundMessageBytesMax - kChunkHeadBytesMax) {
    return std::unexpected(CodecError::kTooLarge);
  }
  std::vector<std::byte> out;
  out.reserve(kHeaderBytes + coded.size());
  put_number(out, kMagic);
  put_number(out, kVersion);
  put_number(out, static_cast<std::uint8_t>(lattice.cells));
  put_number(out, std::uint16_t{0});
  put_number(out, std::bit_cast<std::uint32_t>(static_cast<float>(lattice.step_m)));
  put_number(out, static_cast<std::uint32_t>(used));
  put_number(out, static_cast<std::uint32_t>(mesh.triangles()));
  put_number(out, static_cast<std::uint32_t>(index_bytes));
  out.insert(out.end(), coded.begin(), coded.end());
  return out;
}

std::expected<ChunkMesh, CodecError> decode_meshopt(std::span<const std::byte> bytes, const MeshLattice& lattice) {
  constexpr auto kMalformed = std::unexpected(CodecError::kMalformed);
  if (bytes.size() > kOutboundMessageBytesMax) return std::unexpected(CodecError::kTooLarge);
  if (bytes.size() < kHeaderBytes || number_at<std::uint32_t>(bytes, 0) != kMagic ||
      number_at<std::uint8_t>(bytes, 4) != kVersion || number_at<std::uint8_t>(bytes, 5) != lattice.cells ||
      number_at<std::uint16_t>(bytes, 6) != 0 ||
      std::bit_cast<float>(number_at<std::uint32_t>(bytes, 8)) != static_cast<float>(lattice.step_m)) {
    return kMalformed;
  }
  const std::size_t points = number_at<std::uint32_t>(bytes, 12);
  const std::size_t triangles = number_at<std::uint32_t>(bytes, 16);
  const std::size_t index_bytes = number_at<std::uint32_t>(bytes, 20);
  if (triangles == 0 || triangles > lattice.triangles_max || points == 0 || points > 3 * triangles ||
      index_bytes > bytes.size() - kHeaderBytes) {
    return kMalformed;
  }
  const auto coded_indices = bytes.subspan(kHeaderBytes, index_bytes);
  const auto coded_vertices = bytes.subspan(kHeaderBytes + index_bytes);

  ChunkMesh out;
  out.indices.resize(3 * triangles);
  if (meshopt_decodeIndexBuffer(out.indices.data(), out.indices.size(), sizeof(std::uint32_t), raw(coded_indices),
                                coded_indices.size()) != 0) {
    return kMalformed;
  }
  for (const std::uint32_t index : out.indices) {
    if (index >= points) return kMalformed;
  }
  std::vector<LatticeVertex> vertices(points);
  if (meshopt_decodeVertexBuffer(vertices.data(), points, sizeof(LatticeVertex), raw(coded_vertices),
                                 coded_vertices.size()) != 0) {
    return kMalformed;
  }
  for (const LatticeVertex& vertex : vertices) {
    const auto position = position_of(vertex, lattice.cells);
    if (!position) return kMalformed;
    out.positions.push_back(*position);
    out.normals.push_back(normal_of(vertex));
    out.materials.push_back(vertex.material);
    out.ridges.push_back(vertex.ridge);
  }
  return out;
}

std::expected<ChunkMesh, CodecError> decode_surface(std::span<const std::byte> bytes, const MeshLattice& lattice) {
  const bool is_meshopt = bytes.size() >= sizeof kMagic && number_at<std::uint32_t>(bytes, 0) == kMagic;
  return is_meshopt ? decode_meshopt(bytes, lattice) : decode_draco(bytes, lattice);
}

}  // namespace talus::protocol
