// The numbers both ends agree on before they have spoken: protocol/limits.hpp, as far as a viewer needs them.

/// Without the strips of version 2 there would be light between LODs.
export const kVersionLow = 2;
export const kVersionHigh = 3;

/// Largest message a server sends, in bytes; anything longer is a broken peer.
export const kServerMessageBytesMax = 1024 * 1024;
/// Keys in one `held` message: 64 KiB / 24 B, less the head.
export const kKeysPerMessageMax = 2600;

export const kLodMax = 12;
/// Chunk coordinates reach +-this at every LOD.
export const kChunkLimit = 2 ** 30 - 1;
/// Coarsest LOD of an interest area.
export const kViewLodMax = 8;
/// LOD 0 reaches at least this many chunk edges.
export const kNearEdgesMin = 3.5;
