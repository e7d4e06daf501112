// What lies on the disk for one payload, byte by byte. Pure.
//
// A disk lends bytes and may give others back: a torn write, a flipped bit, another version's file. An entry therefore
// says what it is and proves it; whatever cannot is a fault, never a payload.
//
//   head: u32 magic and version | u8 kind | u8[3] zero | u32 payload_bytes | u8[16] checksum        (little-endian)
//   payload: bytes as a door sends them
//
// The checksum is the first half of SHA-256 over the entry's name, what stands before the checksum, and the payload: an
// entry found under another name is a fault like any other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string_view>

namespace talus::server {

inline constexpr std::size_t kEntryHeadBytes = 28;  // 4 + 1 + 3 + 4 + 16
/// Larger than any payload.
inline constexpr std::size_t kEntryPayloadBytesMax = 16 * 1024 * 1024;

enum class EntryFault : std::uint8_t {
  kTruncated,  ///< shorter than a head, or than its head says
  kVersion,    ///< not an entry, or one of another version
  kSize,       ///< longer than its head says, or than any payload may be
  kChecksum    ///< its bytes are not those that were stored under this name
};

using EntryHead = std::array<std::byte, kEntryHeadBytes>;

/// The head to be written before `payload`, of at most kEntryPayloadBytesMax.
EntryHead encode_entry_head(std::string_view name, std::uint8_t kind, std::span<const std::byte> payload);

/// The kind of the entry, when it is one and `payload` is its payload. Any bytes may be given.
std::expected<std::uint8_t, EntryFault> decode_entry(std::string_view name, std::span<const std::byte> head,
                                                     std::span<const std::byte> payload);

/// Where the entry of `name` lies: the first 8 bytes of SHA-256, as a signed number. Two names may share a place (once
/// in 2^32 entries); the checksum tells them apart, and the later takes it.
std::int64_t entry_place(std::string_view name);

}  // namespace talus::server
