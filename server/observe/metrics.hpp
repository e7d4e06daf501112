// Everything the server counts, in one table: a limit without a number here cannot be seen to work.
//
// Counters and histograms are fixed arrays of atomics, so counting costs one relaxed add and no look-up. Readings are
// functions, asked when the metrics are read. Any thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "server/observe/latency_histogram.hpp"

namespace talus::server {

/// The stations of the data walk, in its order.
enum class Hop : std::uint8_t {
  kReadLoop,
  kNextMessage,
  kDecode,
  kOnMessage,
  kRequest,
  kLoad,
  kBuildChunk,
  kEncodeChunk,
  kDrawMap,  ///< what a map tile passes instead of kBuildChunk and kEncodeChunk
  kEncodeMap,
  kPublish,
  kWriteLoop,
  kQueue,         ///< beside the walk: from a job's coming to its start
  kLoadStored,    ///< beside the walk: reading the disk instead of building
  kCommitStored,  ///< behind it: a batch written to the disk
  kEnd
};

enum class Count : std::uint8_t {
  kHttpOk,
  kHttpNoContent,
  kHttpNotModified,
  kHttpClientError,
  kHttpServerError,
  kHttpBodyBytes,
  kHttpChunkInMemory,
  kHttpChunkFromPool,
  kBadRequest,
  kUriTooLong,
  kHeadTooLarge,
  kBodyTooLarge,
  kHeadTimeout,
  kIdleTimeout,
  kSilentTimeout,
  kWriteStalled,
  kReadTooSlow,
  kRequestsExhausted,
  kConnectionsAccepted,
  kConnectionsRefusedTotal,
  kConnectionsRefusedAddress,
  kConnectionsRefusedDescriptors,
  kConnectionFault,
  kTlsEstablished,
  kTlsFailed,
  kTokenMissing,
  kTokenBad,
  kTokenExpired,
  kTokenNotYet,
  kTokenOtherWorld,
  kOriginRefused,
  kReloads,
  kReloadsRefused,
  kChunkHit,
  kChunkBuilt,
  kChunkStored,
  kChunkRuledOut,
  kChunkJoined,
  kChunkShed,
  kChunkOverShare,
  kChunkDisplaced,
  kChunkCancelled,
  kChunkFailed,
  kChunkHung,
  kDiskHit,
  kDiskMiss,
  kDiskBad,
  kDiskStored,
  kDiskEvicted,
  kDiskShed,
  kDiskFault,
  kColumnsRemembered,
  kColumnsEvaluated,
  kTilesRemembered,
  kTilesEvaluated,
  kHeightsRemembered,
  kHeightsUnknown,
  kQueryShed,
  kSessionsOpened,
  kSessionsRefused,
  kMessagesReceived,
  kViewCutShort,
  kByeMalformed,
  kByeTooManyMessages,
  kByeTooSlow,
  kMessageTimeout,
  kByeSilent,
  kByeDraining,
  kByeInternal,
  kChunksSent,
  kChunkBytesSent,
  kSendShed,
  kSendOverflow,
  kCreditWaits,
  kEnd
};

using Reading = std::move_only_function<double() const>;
/// What a reading is called. Readings of one family, told apart by a label, are added one after the other.
struct ReadingInfo {
  std::string family;
  std::string help;
  std::string label;  ///< name of the one label; empty: none
  std::string label_value;
  bool is_counter = false;  ///< it only grows
};

class Metrics {
 public:
  void add(Count count, std::uint64_t by = 1) {
    counts_[static_cast<std::size_t>(count)].fetch_add(by, std::memory_order_relaxed);
  }
  std::uint64_t value(Count count) const {
    return counts_[static_cast<std::size_t>(count)].load(std::memory_order_relaxed);
  }
  void record(Hop hop, std::chrono::nanoseconds took) { hops_[static_cast<std::size_t>(hop)].record(took); }
  const LatencyHistogram& hop(Hop hop) const { return hops_[static_cast<std::size_t>(hop)]; }

  /// `reading` is called whenever the metrics are read, on the reader's thread, and must stay callable until then.
  void watch(ReadingInfo info, Reading reading);

  /// Prometheus' text format, version 0.0.4.
  std::string text() const;

 private:
  struct Watched {
    ReadingInfo info;
    Reading reading;
  };
  std::array<std::atomic<std::uint64_t>, static_cast<std::size_t>(Count::kEnd)> counts_{};
  std::array<LatencyHistogram, static_cast<std::size_t>(Hop::kEnd)> hops_;
  mutable std::mutex watched_mutex_;
  std::vector<Watched> watched_;
};

}  // namespace talus::server
