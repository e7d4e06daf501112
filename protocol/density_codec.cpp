// DensityTile <-> bytes. SPEC.md, "Density tiles". Above and below ground the density is nearly linear in y, so a
// sample is expected on the line through the two under it: a third fewer bytes than the parallelepiped of its seven
// neighbours.
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/check.hpp"
#include "protocol/limits.hpp"
#include "protocol/tile_bytes.hpp"
#include "protocol/tile_codec.hpp"

namespace talus::protocol {
namespace {

constexpr std::uint32_t kDensityMagic = 0x64736C74;  // "tlsd"
constexpr std::uint8_t kDensityVersion = 1;
/// Zstd levels beyond it save 1 % at twice the time.
constexpr int kDensityLevel = 1;
constexpr std::size_t kPlanes = 3;  // low and high bytes of residuals, materials

std::size_t samples_of(int cells) {
  const auto count = static_cast<std::size_t>(cells + 1);
  return count * count * count;
}

/// Calls at(sample, expectation) for every sample in order; the expectation is made of densities before it.
template <class At>
void predict(const std::int16_t* densities, int cells, At at) {
  const int count = cells + 1;
  const int layer = count * count;
  const std::int16_t* p = densities;
  std::size_t sample = 0;
  for (int j = 0; j < count; ++j) {
    for (int k = 0; k < count; ++k) {
      for (int i = 0; i < count; ++i, ++p, ++sample) {
        int expected = 0;
        if (j >= 2) {
          expected = 2 * p[-layer] - p[-2 * layer];
        } else if (j == 1) {  // as much above the sample below as its neighbour is
          const int rise = i > 0 ? p[-1] - p[-1 - layer] : k > 0 ? p[-count] - p[-count - layer] : kDensityStepsPerCell;
          expected = p[-layer] + rise;
        } else if (i > 0 && k > 0) {
          expected = p[-1] + p[-count] - p[-count - 1];
        } else if (i > 0 || k > 0) {
          expected = i > 0 ? p[-1] : p[-count];
        }
        at(sample, std::clamp(expected, -kDensityHeld, kDensityHeld - 1));
      }
    }
  }
}

}  // namespace

std::expected<std::vector<std::byte>, CodecError> encode_density(const DensityTile& tile, const ChunkKey& key) {
  TALUS_CHECK(tile.cells > 0 && tile.cells <= kTileCellsMax);
  const std::size_t samples = samples_of(tile.cells);
  TALUS_CHECK(tile.densities.size() == samples && tile.materials.size() == samples);
  std::vector<std::byte> content(kPlanes * samples);
  predict(tile.densities.data(), tile.cells, [&](std::size_t at, int expected) {
    const std::uint32_t left = zigzag(static_cast<std::uint32_t>(tile.densities[at] - expected));
    content[at] = static_cast<std::byte>(left);
    content[samples + at] = static_cast<std::byte>(left >> 8U);
  });
  for (std::size_t at = 0; at < samples; ++at) content[2 * samples + at] = static_cast<std::byte>(tile.materials[at]);

  std::vector<std::byte> out;
  put_number(out, kDensityMagic);
  put_number(out, kDensityVersion);
  put_number(out, static_cast<std::uint8_t>(key.lod));
  put_number(out, static_cast<std::uint8_t>(tile.cells));
  put_number(out, std::uint8_t{0});
  put_number(out, key.x);
  put_number(out, key.y);
  put_number(out, key.z);
  put_number(out, std::bit_cast<std::uint32_t>(static_cast<float>(tile.step_m)));
  if (const auto packed = append_packed(content, kDensityLevel, out); !packed) return std::unexpected(packed.error());
  return out;
}

std::expected<DecodedDensity, CodecError> decode_density(std::span<const std::byte> bytes) {
  constexpr auto kMalformed = std::unexpected(CodecError::kMalformed);
  if (bytes.size() > kOutboundMessageBytesMax) return std::unexpected(CodecError::kTooLarge);
  if (bytes.size() < kDensityHeaderBytes || number_at<std::uint32_t>(bytes, 0) != kDensityMagic ||
      number_at<std::uint8_t>(bytes, 4) != kDensityVersion || number_at<std::uint8_t>(bytes, 7) != 0) {
    return kMalformed;
  }
  DecodedDensity out;
  out.key = {number_at<std::uint8_t>(bytes, 5), number_at<std::int32_t>(bytes, 8), number_at<std::int32_t>(bytes, 12),
             number_at<std::int32_t>(bytes, 16)};
  DensityTile& tile = out.tile;
  tile.cells = number_at<std::uint8_t>(bytes, 6);
  tile.step_m = static_cast<double>(std::bit_cast<float>(number_at<std::uint32_t>(bytes, 20)));
  int exponent = 0;
  const bool is_step = std::isfinite(tile.step_m) && std::frexp(tile.step_m, &exponent) == 0.5;
  if (!is_valid(out.key) || tile.cells < 1 || tile.cells > kTileCellsMax || !is_step) return kMalformed;

  const std::size_t samples = samples_of(tile.cells);
  const auto content = unpack(bytes.subspan(kDensityHeaderBytes), kPlanes * samples);
  if (!content) return std::unexpected(content.error());
  const auto byte_at = [&](std::size_t i) { return std::to_integer<std::uint8_t>((*content)[i]); };
  tile.densities.resize(samples);
  tile.materials.resize(samples);
  bool is_held = true;
  predict(tile.densities.data(), tile.cells, [&](std::size_t at, int expected) {
    const std::uint32_t left = byte_at(at) | std::uint32_t{byte_at(samples + at)} << 8U;
    const int density = expected + static_cast<std::int32_t>(unzigzag(left));
    is_held = is_held && density >= -kDensityHeld && density < kDensityHeld;
    tile.densities[at] = static_cast<std::int16_t>(std::clamp(density, -kDensityHeld, kDensityHeld - 1));
    tile.materials[at] = byte_at(2 * samples + at);
  });
  if (!is_held) return kMalformed;
  return out;
}

}  // namespace talus::protocol
