// What an engine uses: a viewer of one world that decodes, reconnects and resumes.
//
// A WorldStream is one connection and its messages. A WorldViewer lasts: it keeps count of what has arrived, comes back
// after a lost connection with it, so that nothing is sent twice, and hands out meshes. It speaks in events, in the
// order in which the server said them; README.md beside this file shows a whole program.
//
// Threads: one thread owns the viewer and its loop and calls everything but `decode_one`, which any number of other
// threads may call at once. No thread is started here. Memory: what has arrived and was not taken yet is at most
// `credit_bytes` of messages, and their meshes.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "client_sample/library/connection.hpp"
#include "client_sample/library/world_info.hpp"
#include "core/mesh/chunk_mesh.hpp"
#include "protocol/message.hpp"

namespace talus::client {

struct ViewerOptions {
  ServerAddress server;                       ///< parse_server_url; WebSocket or TCP
  std::string world = "default";              ///< a name of GET /v1/worlds
  std::string client = "talus library";       ///< named in the server's log: say which engine this is
  std::uint64_t credit_bytes = 4ULL << 20U;   ///< under way or not taken yet, at most: more hides latency, less lag.
                                              ///< From 1.25 MiB: the largest message is 1 MiB, and up to an eighth of
                                              ///< the credit is on its way back
  bool decodes_in_next = true;                ///< false: only decode_one does, and `next` never takes long
  std::chrono::milliseconds retry_min{250};   ///< wait before the first new attempt; doubles, with a little chance, so
  std::chrono::milliseconds retry_max{8000};  ///< that all clients of a server that comes back do not come as one
};

/// The server has let the viewer in, for the first time or again.
struct Connected {
  WorldInfo info;
};
/// The connection is gone; what was handed out stays valid and may be drawn.
struct Disconnected {
  ClientError why;
  std::optional<std::chrono::milliseconds> retry_in;  ///< nothing: trying again would not help, and is not done
};
/// A chunk, whole: replaces what was handed out of this key before.
struct ChunkReady {
  ChunkKey key;
  ChunkKind kind = ChunkKind::kAir;
  std::uint8_t faces = 0;  ///< that the surface reaches, bits of ChunkFace
  double step_m = 0.0;     ///< a vertex is at box_of(key).low + position * step_m
  ChunkMesh mesh;          ///< of kind mesh
};
/// What closes a chunk to finer ones across one of its faces; belongs to its chunk and goes with it.
struct StripReady {
  StripKey key;
  double step_m = 0.0;  ///< counted from the lowest corner of key.key as well
  ChunkMesh mesh;       ///< may be without triangles
};
/// The server cannot make this chunk, or this strip of it; it will not come. Go on drawing what is in its place.
struct Unmade {
  ChunkKey key;
  std::optional<ChunkFace> face;  ///< nothing for the chunk itself
};
/// No longer part of what was looked at or wanted: may be freed once nothing better is to come in its place.
struct Forget {
  std::vector<ChunkKey> keys;
};
/// Everything that this look, and the latest want, ask for has been handed out, but what is Unmade.
struct Complete {
  std::uint32_t look = 0;  ///< what `look` returned; 0 before the first
};

using ViewerEvent = std::variant<Connected, Disconnected, ChunkReady, StripReady, Unmade, Forget, Complete>;

class WorldViewer {
 public:
  /// Connects in the background; `loop` outlives the viewer and has to be polled.
  WorldViewer(Loop& loop, ViewerOptions options);
  /// Drops the connection. Nobody may be inside decode_one: `stop_decoding`, join, then destroy.
  ~WorldViewer();
  WorldViewer(const WorldViewer&) = delete;
  WorldViewer& operator=(const WorldViewer&) = delete;

  /// Where the camera is and what it sees (protocol/interest_area.hpp says what follows from it). The latest wins; ten
  /// times a second is plenty. Returns its number, which Complete names. May be called at any time, connected or not.
  std::uint32_t look(const protocol::View& view);
  /// Chunks by name, nearest first, instead of a look or besides it; the latest wins. At most 2600.
  void want(std::vector<ChunkKey> keys);

  /// The next event, or nothing for the moment. Credit returns to the server by this: an engine that takes at most so
  /// many milliseconds' worth of events a frame is sent no more than that.
  std::optional<ViewerEvent> next();

  /// Decodes one surface; waits at most `patience` for one to come. False if none came. Any thread.
  bool decode_one(std::chrono::milliseconds patience);
  /// Ends the waits of decode_one, for good. Any thread.
  void stop_decoding();

  /// Says goodbye; Disconnected comes once more, without another attempt.
  void close();

  /// Of the world last connected to; nothing before the first time.
  const std::optional<WorldInfo>& info() const;
  bool is_connected() const;
  /// Chunks handed out or on their way to `next`, less those that were left.
  std::size_t held() const;

 private:
  class Session;
  std::unique_ptr<Session> session_;
};

}  // namespace talus::client
