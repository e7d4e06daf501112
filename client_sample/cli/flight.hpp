// One headless viewer on its way: what it asked for, what came and when. Owner: the loop's thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "client_sample/library/world_stream.hpp"
#include "core/mesh/chunk_mesh.hpp"

namespace talus::cli {

/// What a flight has seen so far. Times are seconds since it began to connect.
struct FlightLog {
  std::optional<double> welcome_s;
  std::optional<double> first_chunk_s;
  std::optional<double> first_ground_s;  ///< a surface of LOD 0 in the column of chunks the viewer is in
  std::optional<double> complete_s;      ///< everything of a view that was still the latest has come
  std::uint64_t meshes = 0;
  std::uint64_t empties = 0;  ///< chunks of air or rock
  std::uint64_t strips = 0;   ///< with triangles
  std::uint64_t strip_bytes = 0;
  std::uint64_t leaves = 0;
  std::uint64_t bytes = 0;      ///< of payloads
  std::uint64_t triangles = 0;  ///< only when meshes are decoded
  std::uint64_t views = 0;
  std::uint64_t idles = 0;
  std::uint32_t wanted = 0;  ///< chunks of the latest view, as the server counts them
  std::optional<client::ClientError> error;

  std::uint64_t chunks() const { return meshes + empties; }
};

class Flight {
 public:
  /// Connects at once. `decodes`: every mesh is decoded, and one that cannot be is an error.
  Flight(client::Loop& loop, client::StreamOptions options, bool decodes);

  /// Says where the viewer is and looks along its way.
  void look(const protocol::View& view);
  void close() { stream_.close(); }

  const FlightLog& log() const { return log_; }
  bool is_over() const { return is_over_; }

 private:
  using Clock = std::chrono::steady_clock;

  client::StreamHandlers handlers();
  double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }
  void on_chunk(const client::ArrivedChunk& chunk);
  bool is_under_viewer(const ChunkKey& key) const;

  const bool decodes_;
  const Clock::time_point began_ = Clock::now();
  FlightLog log_;
  bool is_over_ = false;
  std::uint32_t sequence_ = 0;
  protocol::View view_;
  client::WorldStream stream_;  ///< last: its handlers use all of the above
};

}  // namespace talus::cli
