// Surfaces out of bytes, on whatever threads there are.
//
// Problem: a surface takes about 0.5 ms to decode, an engine's frame has a few, and a hundred surfaces come at once.
// Answer: what came waits here in order; any thread may take the next that nobody has begun, and whoever owns the queue
// takes results from its front, so that they stay in the order of arrival.
//
// Owner: any thread calls decode_one and stop, one thread all else. The one lock is held for a look at the queue, never
// while decoding.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/mesh/chunk_mesh.hpp"
#include "protocol/codec_error.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::client {

class DecodeQueue {
 public:
  /// One surface on its way.
  struct Work {
    std::vector<std::byte> bytes;  ///< Draco; let go of once decoded
    protocol::MeshLattice lattice;
    ChunkMesh mesh;                             ///< once done, unless `fault`
    std::optional<protocol::CodecError> fault;  ///< once done: the bytes are no surface
  };
  using WorkRef = std::shared_ptr<Work>;

  /// Copies `payload`. An empty one is a surface without triangles and done at once.
  WorkRef push(std::span<const std::byte> payload, const protocol::MeshLattice& lattice);
  /// Whether `work` is decoded; if not and nobody has begun it, and `decodes_here`, it is decoded now.
  bool is_done(const WorkRef& work, bool decodes_here);

  /// Decodes what has waited longest; waits for at most `patience` for something to come. False if nothing came.
  bool decode_one(std::chrono::milliseconds patience);
  /// What nobody has begun to decode is dropped.
  void clear();
  /// Every wait ends, and later ones return at once.
  void stop();

 private:
  static void decode(Work& work);
  void finish(const WorkRef& work);

  std::mutex mutex_;  ///< guards all below
  std::condition_variable came_;
  std::deque<WorkRef> waiting_;
  std::vector<WorkRef> begun_;  ///< by some thread; about as many as there are threads
  bool is_stopped_ = false;
};

}  // namespace talus::client
