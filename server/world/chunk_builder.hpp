// From a payload's name to its bytes, on a thread of the pool.
#pragma once

#include <cstddef>
#include <optional>

#include "server/cache/payload.hpp"
#include "server/schedule/cancel_token.hpp"

namespace talus::server {

/// A chunk that needs no bytes and no work to know.
struct RuledOut {
  ChunkKind kind = ChunkKind::kAir;
  bool is_learnt = false;  ///< from chunks that were built: the next process would not know it
};

class ChunkBuilder {
 public:
  ChunkBuilder() = default;
  virtual ~ChunkBuilder() = default;
  ChunkBuilder(const ChunkBuilder&) = delete;
  ChunkBuilder& operator=(const ChunkBuilder&) = delete;

  /// Nothing when the chunk has to be built. Cheap; any thread.
  virtual std::optional<RuledOut> ruled_out(const PayloadName& /*name*/) const { return std::nullopt; }
  /// What building is expected to take, from what is known without doing any of it. Cheap; any thread.
  virtual double predicted_s(const PayloadName& /*name*/) const { return 0.001; }

  /// Nothing when `token` was cancelled on the way. Throws when the chunk cannot be made. `thread` is the index of the
  /// calling pool thread; two calls with the same index never run at once.
  virtual std::optional<ChunkPayload> build(const PayloadName& name, std::size_t thread, const CancelToken& token) = 0;
};

}  // namespace talus::server
