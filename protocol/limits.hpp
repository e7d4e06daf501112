// The numbers both ends of a connection agree on before they have spoken. Configurable limits are the server's
// (server/app).
#pragma once

#include <cstddef>
#include <cstdint>

namespace talus::protocol {

inline constexpr std::uint16_t kVersionLow = 1;   ///< oldest version this build speaks
inline constexpr std::uint16_t kVersionHigh = 3;  ///< newest
/// First version in which strips are sent.
inline constexpr std::uint16_t kVersionOfStrips = 2;
/// First version in which a client is told what cannot be made.
inline constexpr std::uint16_t kVersionOfFailures = 3;

/// Largest message a client may send: head and all, checked on the declared length before anything is allocated.
inline constexpr std::size_t kInboundMessageBytesMax = 64 * 1024;
/// Largest message a server sends: a chunk of 32^3 cells is below 32^3 * 5 triangles * 6 B.
inline constexpr std::size_t kOutboundMessageBytesMax = 1024 * 1024;
/// Largest number of keys in one `held` or `want`: 64 KiB / 24 B, less the head.
inline constexpr std::size_t kKeysPerMessageMax = 2600;
inline constexpr std::size_t kWantedKeysMax = 16'384;

/// `u32 head_bytes` before every head.
inline constexpr std::size_t kPrefixBytes = 4;
/// Largest head. A `welcome` carries the manifest; all else is far below 64 KiB.
inline constexpr std::size_t kHeadBytesMax = 128 * 1024;
/// Prefix and head of any `chunk` or `strip` message; what is left of kOutboundMessageBytesMax is its payload.
inline constexpr std::size_t kChunkHeadBytesMax = 128;
/// Bytes of texts inside messages, UTF-8: names (world, session, format, world hash), tokens, sentences.
inline constexpr std::size_t kNameBytesMax = 64;
inline constexpr std::size_t kTokenBytesMax = 1024;
inline constexpr std::size_t kTextBytesMax = 512;
/// Bytes of the secret that signs tokens; at least as long as its hash (RFC 7518, 3.2).
inline constexpr std::size_t kTokenKeyBytesMin = 32;
inline constexpr std::size_t kTokenKeyBytesMax = 4096;
inline constexpr std::size_t kManifestJsonBytesMax = 96 * 1024;
inline constexpr std::size_t kFormatsMax = 16;   ///< entries of hello.formats
inline constexpr std::size_t kVersionsMax = 64;  ///< entries of refused.versions

/// Coarsest LOD of an interest area.
inline constexpr int kViewLodMax = 8;
/// LOD 0 reaches at least this many chunk edges: below 2 * sqrt(3) = 3.47 neighbouring chunks could differ by two LODs.
inline constexpr double kNearEdgesMin = 3.5;
inline constexpr double kNearEdgesMax = 16.0;
inline constexpr double kFarMax = 32'768.0;  ///< metres
inline constexpr double kLodBiasMax = 2.0;   ///< in both directions

/// Quantised positions: log2(32 cells * 64 steps) + 1 bits, so that the last step is representable.
inline constexpr int kNormalBits = 8;

}  // namespace talus::protocol
