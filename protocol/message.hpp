// Messages <-> bytes. A message is `u32 head_bytes | head | payload`, little-endian; the head is a FlatBuffers Envelope
// of schema/talus.fbs. WebSocket carries one message per binary frame, TCP puts `u32 message_bytes` before each. No
// socket here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/grid/chunk_face.hpp"
#include "core/grid/chunk_key.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "protocol/interest_area.hpp"

namespace talus::protocol {

enum class RefusedReason : std::uint8_t { kVersion, kWorld, kToken, kFormat, kBusy, kMalformed };
enum class ByeReason : std::uint8_t { kLeaving, kDraining, kMalformed, kTooManyMessages, kTooSlow, kSilent, kInternal };

struct HeldChunk {
  ChunkKey key;
  std::uint64_t revision = 0;
  friend bool operator==(const HeldChunk&, const HeldChunk&) = default;
};

struct Hello {
  std::uint16_t version_low = 0;
  std::uint16_t version_high = 0;
  std::string world;
  std::string token;
  std::vector<std::string> formats;
  std::uint64_t credit_bytes = 0;
  std::string client;
};
struct Welcome {
  std::uint16_t version = 0;
  std::string session;
  std::string world_hash;
  std::string format;
  std::string manifest_json;
};
struct Refused {
  RefusedReason reason{};
  std::string message;
  std::vector<std::uint16_t> versions;
};
struct ViewMessage {
  std::uint32_t sequence = 0;
  View view;
};
struct ViewAccepted {
  std::uint32_t sequence = 0;
  View view;  ///< position, near_m, far_m, lod_bias
  std::uint32_t chunks = 0;
};
struct Held {
  std::vector<HeldChunk> chunks;
  std::vector<std::uint8_t> faces{};  ///< ChunkHead::faces of each of `chunks`; shorter: of the rest it is not known
  std::vector<StripKey> strips{};
};
struct Want {
  std::vector<HeldChunk> chunks;
  std::vector<StripKey> strips{};
};
struct ChunkHead {
  ChunkKey key;
  std::uint64_t revision = 0;
  ChunkKind kind{};
  std::uint32_t payload_bytes = 0;
  std::uint8_t faces = 0;  ///< that the surface reaches, bits of ChunkFace
};
struct StripHead {
  StripKey strip;
  std::uint64_t revision = 0;
  std::uint32_t payload_bytes = 0;  ///< 0: an empty strip
};
/// What was asked for and cannot be made.
struct Failed {
  ChunkKey key;
  std::optional<ChunkFace> face{};  ///< of a strip; nothing for the chunk itself
};
struct Leave {
  std::vector<ChunkKey> keys;
};
struct Idle {
  std::uint32_t view_sequence = 0;
  std::uint64_t chunks_sent = 0;
};
struct Credit {
  std::uint64_t bytes = 0;
};
struct Ping {
  std::uint64_t nonce = 0;
};
struct Pong {
  std::uint64_t nonce = 0;
};
struct Bye {
  ByeReason reason{};
  std::string message;
};

using Message = std::variant<Hello, Welcome, Refused, ViewMessage, ViewAccepted, Held, Want, ChunkHead, Leave, Idle,
                             Credit, Ping, Pong, Bye, StripHead, Failed>;
std::string_view name_of(const Message& message);
std::string_view name_of(ByeReason reason);
std::string_view name_of(RefusedReason reason);

/// Prefix and head; a chunk's or strip's payload is sent right behind it, never copied into it. Requires lists within
/// kKeysPerMessageMax (chunks and strips counted together) and a payload exactly when a chunk is a mesh.
std::vector<std::byte> encode(const Message& message);

enum class MessageError { kTooShort, kTooLarge, kMalformed, kUnknown, kBadKey };
std::string_view describe(MessageError error);

struct Decoded {
  Message message;
  std::span<const std::byte> payload;  ///< into the argument of decode; empty but for a mesh or a strip
};
/// Safe on any bytes. Keys are valid, strings and lists bounded; a View is as it came (see `clamped`).
std::expected<Decoded, MessageError> decode(std::span<const std::byte> bytes);

}  // namespace talus::protocol
