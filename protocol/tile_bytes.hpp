// What the codecs of tiles have in common: headers read and written field by field, residuals in planes of bytes, and
// one zstd frame of a length known before it is opened. Pure.
//
// Why planes: residuals of a smooth field need few bits; a plane of low bytes and planes that are nearly all zero pack
// better, and quicker, than words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <expected>
#include <span>
#include <vector>

#include "protocol/codec_error.hpp"

namespace talus::protocol {

/// Small magnitudes of either sign become small numbers: 0, -1, 1, -2 .. -> 0, 1, 2, 3 ..
constexpr std::uint32_t zigzag(std::uint32_t difference) {
  return (difference << 1U) ^ (0U - (difference >> 31U));
}
constexpr std::uint32_t unzigzag(std::uint32_t folded) {
  return (folded >> 1U) ^ (0U - (folded & 1U));
}

/// Little-endian whatever the machine.
template <typename T>
void put_number(std::vector<std::byte>& out, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    out.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }
}
template <typename T>
T number_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) out |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  return static_cast<T>(out);
}

/// Appends one zstd frame of `content`, without a checksum. `level` is zstd's own.
std::expected<void, CodecError> append_packed(std::span<const std::byte> content, int level,
                                              std::vector<std::byte>& out);

/// The content of `packed`, which must be exactly one zstd frame of exactly `content_bytes`. Nothing is allocated
/// before the frame has said so.
std::expected<std::vector<std::byte>, CodecError> unpack(std::span<const std::byte> packed, std::size_t content_bytes);

}  // namespace talus::protocol
