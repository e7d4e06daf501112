// Everything the server counts, in one table: a limit without a number here cannot be seen to work.
//
// Each thread counts on a page of its own, so that counting costs one plain add: no look-up, no locked instruction, no
// line that goes from core to core. Who reads adds the pages up. Readings are functions, asked when the metrics are
// read. Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
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
  Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void add(Count count, std::uint64_t by = 1) { page().counts[static_cast<std::size_t>(count)].add(by); }
  std::uint64_t value(Count count) const;
  void record(Hop hop, std::chrono::nanoseconds took) { page().hops[static_cast<std::size_t>(hop)].record(took); }

  /// `reading` is called whenever the metrics are read, on the reader's thread, and must stay callable until then.
  void watch(ReadingInfo info, Reading reading);

  /// Prometheus' text format, version 0.0.4.
  std::string text() const;

 private:
  struct Watched {
    ReadingInfo info;
    Reading reading;
  };
  struct Page {
    std::array<OwnCount, static_cast<std::size_t>(Count::kEnd)> counts;
    std::array<LatencyHistogram, static_cast<std::size_t>(Hop::kEnd)> hops;
    std::thread::id owner;  ///< a later thread of the same id goes on with it
  };
  /// Which page the present thread counts on, of which metrics.
  struct Mine {
    std::uint64_t metrics;  ///< their number_; 0: none yet
    Page* page;
  };

  Page& page() {
    if (mine.metrics != number_) mine = {number_, &page_of_this_thread()};
    return *mine.page;
  }
  Page& page_of_this_thread();
  void add_up(Hop hop, LatencyHistogram& sum) const;

  static inline constinit thread_local Mine mine{};

  const std::uint64_t number_;  ///< no other metrics of this process have it
  mutable std::mutex pages_mutex_;
  std::vector<std::unique_ptr<Page>> pages_;
  mutable std::mutex watched_mutex_;
  std::vector<Watched> watched_;
};

}  // namespace talus::server
