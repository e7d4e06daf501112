#include "client_sample/library/handshake.hpp"
#include "client_sample/library/websocket_frames.hpp"
#include "client_sample/library/world_info.hpp"
#include "core/base/check.hpp"
#include "tests/fuzz/fuzz_one.hpp"

// A server's bytes as the client reads them. The first byte says how they are cut.
int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::client;
  if (size == 0) return 0;
  constexpr std::size_t kMessageBytesMax = 1000;
  const std::span<const std::byte> all = std::as_bytes(std::span(data, size));
  FrameReader reader(kMessageBytesMax);
  const std::size_t cut = 1 + data[0] % 16U;
  for (std::size_t at = 1; at < size; at += cut) {
    reader.feed(all.subspan(at, std::min(cut, size - at)));
    while (const auto event = reader.next()) TALUS_CHECK(event->bytes.size() <= kMessageBytesMax);
  }
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  (void)handshake_fault(text, "key");
  (void)parse_world_info(text);
  (void)parse_spawn(text);
  return 0;
}
