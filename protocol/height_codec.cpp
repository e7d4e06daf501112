// HeightTile <-> bytes. SPEC.md, "Height tiles". Heights are predicted by the plane through three neighbours that are
// known already; what is left of noise and curvature goes to zstd by planes of bytes.
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/check.hpp"
#include "protocol/limits.hpp"
#include "protocol/tile_bytes.hpp"
#include "protocol/tile_codec.hpp"

namespace talus::protocol {
namespace {

constexpr std::uint32_t kHeightMagic = 0x68736C74;  // "tlsh"
constexpr std::uint8_t kHeightVersion = 1;
/// Zstd levels beyond it save 1-2 % at three times the time.
constexpr int kHeightLevel = 3;

std::size_t columns_of(int cells) {
  return static_cast<std::size_t>(cells + 1) * static_cast<std::size_t>(cells + 1);
}

/// What column `at` (of row length `count`) is expected to be, modulo 2^32, from the columns before it.
std::uint32_t predicted(const std::int32_t* heights, std::size_t at, std::size_t count, std::int32_t first) {
  const auto known = [&](std::size_t i) { return static_cast<std::uint32_t>(heights[i]); };
  if (at == 0) return static_cast<std::uint32_t>(first);
  if (at < count) return known(at - 1);
  if (at % count == 0) return known(at - count);
  return known(at - 1) + known(at - count) - known(at - count - 1);
}

}  // namespace

std::expected<std::vector<std::byte>, CodecError> encode_height(const HeightTile& tile, const ChunkKey& key) {
  const std::size_t columns = columns_of(tile.cells);
  TALUS_CHECK(tile.cells > 0 && tile.cells <= kTileCellsMax && tile.heights.size() == columns &&
              tile.ridges.size() == columns && tile.materials.size() == columns);
  const auto count = static_cast<std::size_t>(tile.cells + 1);
  std::vector<std::uint32_t> left(columns);
  std::uint32_t any = 0;
  for (std::size_t at = 0; at < columns; ++at) {
    const auto height = static_cast<std::uint32_t>(tile.heights[at]);
    left[at] = zigzag(height - predicted(tile.heights.data(), at, count, tile.heights[0]));
    any |= left[at];
  }
  const std::size_t planes = (static_cast<std::size_t>(std::bit_width(any)) + 7) / 8;
  std::vector<std::byte> content;
  content.reserve((planes + 2) * columns);
  for (std::size_t plane = 0; plane < planes; ++plane) {
    for (const std::uint32_t value : left) content.push_back(static_cast<std::byte>(value >> (8 * plane)));
  }
  for (std::size_t at = 0; at < columns; ++at) {
    const std::uint8_t before = at == 0 ? 0 : tile.ridges[at < count ? at - 1 : at - count];
    content.push_back(static_cast<std::byte>(tile.ridges[at] - before));
  }
  for (const std::uint8_t material : tile.materials) content.push_back(static_cast<std::byte>(material));

  std::vector<std::byte> out;
  put_number(out, kHeightMagic);
  put_number(out, kHeightVersion);
  put_number(out, static_cast<std::uint8_t>(key.lod));
  put_number(out, static_cast<std::uint8_t>(tile.cells));
  put_number(out, static_cast<std::uint8_t>(planes));
  put_number(out, key.x);
  put_number(out, key.z);
  put_number(out, std::bit_cast<std::uint32_t>(static_cast<float>(tile.step_m)));
  put_number(out, tile.heights[0]);
  if (const auto packed = append_packed(content, kHeightLevel, out); !packed) return std::unexpected(packed.error());
  return out;
}

std::expected<DecodedHeight, CodecError> decode_height(std::span<const std::byte> bytes) {
  constexpr auto kMalformed = std::unexpected(CodecError::kMalformed);
  if (bytes.size() > kOutboundMessageBytesMax) return std::unexpected(CodecError::kTooLarge);
  if (bytes.size() < kHeightHeaderBytes || number_at<std::uint32_t>(bytes, 0) != kHeightMagic ||
      number_at<std::uint8_t>(bytes, 4) != kHeightVersion) {
    return kMalformed;
  }
  DecodedHeight out;
  out.key.lod = number_at<std::uint8_t>(bytes, 5);
  out.key.x = number_at<std::int32_t>(bytes, 8);
  out.key.z = number_at<std::int32_t>(bytes, 12);
  HeightTile& tile = out.tile;
  tile.cells = number_at<std::uint8_t>(bytes, 6);
  const auto planes = std::size_t{number_at<std::uint8_t>(bytes, 7)};
  tile.step_m = static_cast<double>(std::bit_cast<float>(number_at<std::uint32_t>(bytes, 16)));
  int exponent = 0;
  const bool is_step = std::isfinite(tile.step_m) && std::frexp(tile.step_m, &exponent) == 0.5;
  if (!is_valid(out.key) || tile.cells < 1 || tile.cells > kTileCellsMax || planes > 4 || !is_step) return kMalformed;

  const std::size_t columns = columns_of(tile.cells);
  const auto count = static_cast<std::size_t>(tile.cells + 1);
  const auto content = unpack(bytes.subspan(kHeightHeaderBytes), (planes + 2) * columns);
  if (!content) return std::unexpected(content.error());
  const auto byte_at = [&](std::size_t i) { return std::to_integer<std::uint8_t>((*content)[i]); };
  tile.heights.resize(columns);
  tile.ridges.resize(columns);
  tile.materials.resize(columns);
  const auto first = number_at<std::int32_t>(bytes, 20);
  for (std::size_t at = 0; at < columns; ++at) {
    std::uint32_t left = 0;
    for (std::size_t plane = 0; plane < planes; ++plane) {
      left |= static_cast<std::uint32_t>(byte_at(plane * columns + at)) << (8 * plane);
    }
    tile.heights[at] = static_cast<std::int32_t>(predicted(tile.heights.data(), at, count, first) + unzigzag(left));
    const std::uint8_t before = at == 0 ? 0 : tile.ridges[at < count ? at - 1 : at - count];
    tile.ridges[at] = static_cast<std::uint8_t>(before + byte_at(planes * columns + at));
    tile.materials[at] = byte_at((planes + 1) * columns + at);
  }
  return out;
}

}  // namespace talus::protocol
