// From a payload's name to its bytes, on a thread of the pool.
#pragma once

#include <cstddef>
#include <optional>

#include "server/cache/payload.hpp"
#include "server/schedule/cancel_token.hpp"

namespace talus::server {

class ChunkBuilder {
 public:
  ChunkBuilder() = default;
  virtual ~ChunkBuilder() = default;
  ChunkBuilder(const ChunkBuilder&) = delete;
  ChunkBuilder& operator=(const ChunkBuilder&) = delete;

  /// Nothing when `token` was cancelled on the way. Throws when the chunk cannot be made. `thread` is the index of the
  /// calling pool thread; two calls with the same index never run at once.
  virtual std::optional<ChunkPayload> build(const PayloadName& name, std::size_t thread, const CancelToken& token) = 0;
};

}  // namespace talus::server
