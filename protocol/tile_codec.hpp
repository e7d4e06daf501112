// Heightfields and density fields as bytes: `.height` and `.density`. SPEC.md sections "Height tiles" and "Density
// tiles". Decoders are safe on any bytes and bounded before they allocate. Deterministic. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <vector>

#include "core/mesh/density_tile.hpp"
#include "core/mesh/height_tile.hpp"
#include "protocol/codec_error.hpp"

namespace talus::protocol {

/// Most cells a tile may have along an edge.
inline constexpr int kTileCellsMax = 62;
/// Both headers: magic, version, lod, cells, planes, key, step, first value.
inline constexpr std::size_t kHeightHeaderBytes = 24;
inline constexpr std::size_t kDensityHeaderBytes = 24;

/// Of a column of chunks: its y does not count and is 0 when decoded.
std::expected<std::vector<std::byte>, CodecError> encode_height(const HeightTile& tile, const ChunkKey& key);
std::expected<std::vector<std::byte>, CodecError> encode_density(const DensityTile& tile, const ChunkKey& key);

struct DecodedHeight {
  ChunkKey key;
  HeightTile tile;
};
std::expected<DecodedHeight, CodecError> decode_height(std::span<const std::byte> bytes);

struct DecodedDensity {
  ChunkKey key;
  DensityTile tile;
};
std::expected<DecodedDensity, CodecError> decode_density(std::span<const std::byte> bytes);

}  // namespace talus::protocol
