// A viewer of one world: says what it sees and is handed the chunks of its interest area.
//
//   Loop loop;
//   WorldStream stream(loop, options, handlers);   // connects in the background
//   each frame: stream.look(view); loop.poll();    // handlers run inside poll(), on this thread
//
// Chunks come nearest first and are the engine's from then on; on_leave says which it may forget. Credit is given back
// as soon as on_chunk returns, so an engine that falls behind is sent less: decode inside it, or hold the bytes and
// set `gives_credit_itself`. After a lost connection make a new stream and pass what is still held as `held`: those
// chunks are not sent again; a WorldViewer does so by itself. No handler may destroy its stream. Owner: the thread of
// the loop.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_sample/library/connection.hpp"
#include "client_sample/library/world_info.hpp"
#include "protocol/message.hpp"

namespace talus::client {

struct StreamOptions {
  ServerAddress server;
  std::string world = "default";
  std::string client = "talus library";             ///< named in the server's log
  std::vector<std::string> formats{"drc"};          ///< by preference: "drc", "mesh"
  std::uint64_t credit_bytes = 4ULL * 1024 * 1024;  ///< bytes under way at most: more hides latency, less lag
  bool gives_credit_itself = false;                 ///< credit returns only through give_credit
  std::vector<protocol::HeldChunk> held;            ///< sent right behind the hello
  std::vector<std::uint8_t> held_faces;             ///< head.faces of each of `held`
  std::vector<StripKey> held_strips;
  std::string held_world_hash;  ///< of which world; of another nothing is said to be held. Empty: of any
};

struct ArrivedChunk {
  protocol::ChunkHead head;
  std::span<const std::byte>
      payload;                      ///< for protocol::decode_surface if of kind mesh, else empty; lives during the call
  std::uint64_t message_bytes = 0;  ///< what it cost of the credit
};

/// What closes a chunk to a finer one across one of its faces. Draw it while the chunk and a finer neighbour there are
/// drawn; forget it with its chunk.
struct ArrivedStrip {
  protocol::StripHead head;
  std::span<const std::byte> payload;  ///< the same on protocol::strip_lattice; empty for a strip without triangles
  std::uint64_t message_bytes = 0;
};

struct StreamHandlers {
  std::function<void(const WorldInfo&)> on_welcome;
  std::function<void(const protocol::ViewAccepted&)> on_view;
  std::function<void(const ArrivedChunk&)> on_chunk;
  std::function<void(const ArrivedStrip&)> on_strip;       ///< none from a server of version 1
  std::function<void(const protocol::Failed&)> on_failed;  ///< the server cannot make it; from version 3
  std::function<void(const std::vector<ChunkKey>&)> on_leave;
  std::function<void(const protocol::Idle&)> on_idle;
  std::function<void(const ClientError&)> on_closed;  ///< once, and nothing after it
};

class WorldStream {
 public:
  WorldStream(Loop& loop, StreamOptions options, StreamHandlers handlers);
  ~WorldStream();
  WorldStream(const WorldStream&) = delete;
  WorldStream& operator=(const WorldStream&) = delete;

  /// The latest wins; returns its number, which ViewAccepted and Idle echo. Before the welcome it waits.
  std::uint32_t look(const protocol::View& view);
  /// Explicit keys, nearest first, instead of an interest area or besides it; the latest wins. The strips between them
  /// come by themselves; `strips` names others, for chunks that are still drawn and no longer wanted.
  void want(std::vector<protocol::HeldChunk> chunks, std::vector<StripKey> strips = {});
  /// Bytes of messages that have been consumed; only with gives_credit_itself. Those of an earlier stream count as
  /// well, where `credit_bytes` was reduced by them; before the welcome they wait for it.
  void give_credit(std::uint64_t bytes);
  /// Says bye.
  void close();
  /// See Connection::stall.
  void stall();

  /// Nothing before the welcome.
  const std::optional<WorldInfo>& info() const;

 private:
  class Viewer;
  std::unique_ptr<Viewer> viewer_;
};

}  // namespace talus::client
