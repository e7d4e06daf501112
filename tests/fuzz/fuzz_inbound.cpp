#include "core/base/check.hpp"
#include "server/net/framing.hpp"
#include "tests/fuzz/fuzz_one.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <vector>

namespace {

using namespace talus::server;

constexpr std::size_t kMessageBytesMax = 1000;
using Event = std::tuple<Inbound::Kind, std::vector<std::byte>, CloseCode>;

struct Read {
  std::vector<Event> events;
  bool is_between_messages = true;  ///< at the end; true behind a fault
  friend bool operator==(const Read&, const Read&) = default;
};

/// What comes of `bytes` cut into pieces of `piece`, up to the first fault.
Read read(bool is_websocket, std::span<const std::byte> bytes, std::size_t piece) {
  const auto framing = is_websocket ? make_websocket_framing(kMessageBytesMax) : make_tcp_framing(kMessageBytesMax);
  Read out;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    framing->feed(bytes.subspan(at, std::min(piece, bytes.size() - at)));
    while (const auto event = framing->next()) {
      TALUS_CHECK(event->bytes.size() <= kMessageBytesMax);
      out.events.emplace_back(event->kind, std::vector(event->bytes.begin(), event->bytes.end()), event->code);
      if (event->kind == Inbound::Kind::kFault) return {std::move(out.events), true};
    }
    out.is_between_messages = framing->is_between_messages();
  }
  return out;
}

}  // namespace

// A client's bytes as the server reads them, over WebSocket and TCP. The first byte says how they are cut, which must
// not change what they mean.
int fuzz_one(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto bytes = std::as_bytes(std::span(data, size)).subspan(1);
  const std::size_t piece = 1 + data[0] % 16U;
  for (const bool is_websocket : {true, false}) {
    TALUS_CHECK(read(is_websocket, bytes, bytes.size() + 1) == read(is_websocket, bytes, piece));
  }
  return 0;
}
