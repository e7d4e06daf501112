// Bytes -> values of messages. Every byte is hostile: the Verifier bounds every offset before it is followed, and every
// text and list is measured before it is copied. Pure.
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

#include "protocol/limits.hpp"
#include "protocol/message.hpp"
#include "protocol/utf8.hpp"
#include "talus_generated.h"

namespace talus::protocol {
namespace {

/// A head is as deep as Envelope -> message -> list of texts.
constexpr flatbuffers::uoffset_t kDepthMax = 4;
constexpr flatbuffers::uoffset_t kTablesMax = 4;

/// Copies fields out of a verified head and keeps the first thing wrong with them.
class FieldReader {
 public:
  const std::optional<MessageError>& error() const { return error_; }

  std::string text(const flatbuffers::String* from, std::size_t bytes_max) {
    if (from == nullptr) return {};
    if (from->size() > bytes_max) return fail(MessageError::kTooLarge), std::string{};
    const std::string_view view(from->c_str(), from->size());
    if (!is_utf8(view)) return fail(MessageError::kMalformed), std::string{};
    return std::string(view);
  }

  ChunkKey key(const wire::Key& from) {
    const ChunkKey key{from.lod(), from.x(), from.y(), from.z()};
    if (!is_valid(key)) fail(MessageError::kBadKey);
    return key;
  }

  std::vector<HeldChunk> held(const flatbuffers::Vector<const wire::HeldKey*>* from) {
    std::vector<HeldChunk> out;
    if (!bounded(from, kKeysPerMessageMax)) return out;
    // The Verifier aligns a list's length, not its elements: each is copied to where it may be read.
    const std::uint8_t* at = from->Data();
    out.reserve(from->size());
    for (std::uint32_t i = 0; i < from->size(); ++i, at += sizeof(wire::HeldKey)) {
      wire::HeldKey item;
      std::memcpy(&item, at, sizeof item);
      out.push_back({key(item.key()), item.revision()});
    }
    return out;
  }

  std::vector<ChunkKey> keys(const flatbuffers::Vector<const wire::Key*>* from) {
    std::vector<ChunkKey> out;
    if (!bounded(from, kKeysPerMessageMax)) return out;
    out.reserve(from->size());
    for (const wire::Key* item : *from) out.push_back(key(*item));
    return out;
  }

  StripKey strip(const wire::Key& chunk, std::int32_t face) {
    if (face < 0 || face >= static_cast<std::int32_t>(kChunkFaces)) {
      fail(MessageError::kBadKey);
      return {};
    }
    return {key(chunk), static_cast<ChunkFace>(face)};
  }

  std::vector<StripKey> strips(const flatbuffers::Vector<const wire::StripKey*>* from) {
    std::vector<StripKey> out;
    if (!bounded(from, kKeysPerMessageMax)) return out;
    out.reserve(from->size());
    for (const wire::StripKey* item : *from) out.push_back(strip(item->key(), item->face()));
    return out;
  }

  std::vector<std::uint8_t> faces(const flatbuffers::Vector<std::uint8_t>* from, std::size_t size_max) {
    if (!bounded(from, size_max)) return {};
    return {from->begin(), from->end()};
  }

  std::vector<std::uint16_t> versions(const flatbuffers::Vector<std::uint16_t>* from) {
    std::vector<std::uint16_t> out;
    if (!bounded(from, kVersionsMax)) return out;
    for (const std::uint16_t version : *from) out.push_back(version);
    return out;
  }

  std::vector<std::string> formats(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* from) {
    std::vector<std::string> out;
    if (!bounded(from, kFormatsMax)) return out;
    for (const flatbuffers::String* item : *from) out.push_back(text(item, kNameBytesMax));
    return out;
  }

  template <typename Ours, typename Theirs>
  Ours enumerator(Theirs from) {
    if (from > Theirs::MAX) fail(MessageError::kMalformed);
    return static_cast<Ours>(from);
  }

  void fail(MessageError error) {
    if (!error_) error_ = error;
  }

 private:
  template <typename List>
  bool bounded(const List* list, std::size_t size_max) {
    if (list == nullptr) return false;
    if (list->size() <= size_max) return true;
    fail(MessageError::kTooLarge);
    return false;
  }

  std::optional<MessageError> error_;
};

glm::dvec3 vec_of(const wire::Vec3* from, const glm::dvec3& absent) {
  return from == nullptr ? absent : glm::dvec3{from->x(), from->y(), from->z()};
}

Hello hello_of(const wire::Hello& m, FieldReader& read) {
  Hello out;
  out.version_low = m.version_low();
  out.version_high = m.version_high();
  out.world = read.text(m.world(), kNameBytesMax);
  out.token = read.text(m.token(), kTokenBytesMax);
  out.formats = read.formats(m.formats());
  out.credit_bytes = m.credit_bytes();
  out.client = read.text(m.client(), kTextBytesMax);
  return out;
}

Welcome welcome_of(const wire::Welcome& m, FieldReader& read) {
  Welcome out;
  out.version = m.version();
  out.session = read.text(m.session(), kNameBytesMax);
  out.world_hash = read.text(m.world_hash(), kNameBytesMax);
  out.format = read.text(m.format(), kNameBytesMax);
  out.manifest_json = read.text(m.manifest_json(), kManifestJsonBytesMax);
  return out;
}

Refused refused_of(const wire::Refused& m, FieldReader& read) {
  Refused out;
  out.reason = read.enumerator<RefusedReason>(m.reason());
  out.message = read.text(m.message(), kTextBytesMax);
  out.versions = read.versions(m.versions());
  return out;
}

ViewMessage view_of(const wire::View& m) {
  const View initial;
  ViewMessage out;
  out.sequence = m.sequence();
  out.view.position = vec_of(m.position(), initial.position);
  out.view.direction = vec_of(m.direction(), initial.direction);
  out.view.velocity = vec_of(m.velocity(), initial.velocity);
  out.view.near_m = m.near_m();
  out.view.far_m = m.far_m();
  out.view.lod_bias = m.lod_bias();
  return out;
}

ViewAccepted view_accepted_of(const wire::ViewAccepted& m) {
  ViewAccepted out;
  out.sequence = m.sequence();
  out.view.position = vec_of(m.position(), out.view.position);
  out.view.near_m = m.near_m();
  out.view.far_m = m.far_m();
  out.view.lod_bias = m.lod_bias();
  out.chunks = m.chunks();
  return out;
}

ChunkHead chunk_of(const wire::Chunk& m, FieldReader& read) {
  ChunkHead out;
  out.key = read.key(*m.key());
  out.revision = m.revision();
  out.kind = read.enumerator<ChunkKind>(m.kind());
  out.payload_bytes = m.payload_bytes();
  out.faces = m.faces();
  if ((out.kind == ChunkKind::kMesh) != (out.payload_bytes != 0)) read.fail(MessageError::kMalformed);
  return out;
}

StripHead strip_of(const wire::Strip& m, FieldReader& read) {
  return {read.strip(*m.key(), m.face()), m.revision(), m.payload_bytes()};
}

Failed failed_of(const wire::Failed& m, FieldReader& read) {
  if (m.face() == -1) return {read.key(*m.key()), std::nullopt};
  const StripKey strip = read.strip(*m.key(), m.face());
  return {strip.key, strip.face};
}

Held held_of(const wire::Held& m, FieldReader& read) {
  Held out;
  out.chunks = read.held(m.chunks());
  out.faces = read.faces(m.faces(), out.chunks.size());
  out.strips = read.strips(m.strips());
  return out;
}

std::expected<Message, MessageError> message_of(const wire::Envelope& envelope, FieldReader& read) {
  switch (envelope.message_type()) {
    case wire::Message::Hello:
      return hello_of(*envelope.message_as_Hello(), read);
    case wire::Message::Welcome:
      return welcome_of(*envelope.message_as_Welcome(), read);
    case wire::Message::Refused:
      return refused_of(*envelope.message_as_Refused(), read);
    case wire::Message::View:
      return view_of(*envelope.message_as_View());
    case wire::Message::ViewAccepted:
      return view_accepted_of(*envelope.message_as_ViewAccepted());
    case wire::Message::Held:
      return held_of(*envelope.message_as_Held(), read);
    case wire::Message::Want:
      return Want{read.held(envelope.message_as_Want()->chunks()), read.strips(envelope.message_as_Want()->strips())};
    case wire::Message::Chunk:
      return chunk_of(*envelope.message_as_Chunk(), read);
    case wire::Message::Strip:
      return strip_of(*envelope.message_as_Strip(), read);
    case wire::Message::Failed:
      return failed_of(*envelope.message_as_Failed(), read);
    case wire::Message::Leave:
      return Leave{read.keys(envelope.message_as_Leave()->keys())};
    case wire::Message::Idle:
      return Idle{envelope.message_as_Idle()->view_sequence(), envelope.message_as_Idle()->chunks_sent()};
    case wire::Message::Credit:
      return Credit{envelope.message_as_Credit()->bytes()};
    case wire::Message::Ping:
      return Ping{envelope.message_as_Ping()->nonce()};
    case wire::Message::Pong:
      return Pong{envelope.message_as_Pong()->nonce()};
    case wire::Message::Bye:
      return Bye{read.enumerator<ByeReason>(envelope.message_as_Bye()->reason()),
                 read.text(envelope.message_as_Bye()->message(), kTextBytesMax)};
    case wire::Message::NONE:
      break;
  }
  return std::unexpected(MessageError::kUnknown);
}

/// Reads a head that starts at a multiple of 8, as FlatBuffers wants its doubles.
std::expected<Message, MessageError> head_of(const std::uint8_t* head, std::size_t bytes) {
  flatbuffers::Verifier::Options options;
  options.max_depth = kDepthMax;
  options.max_tables = kTablesMax;
  flatbuffers::Verifier verifier(head, bytes, options);
  if (!wire::VerifyEnvelopeBuffer(verifier)) return std::unexpected(MessageError::kMalformed);

  FieldReader read;
  auto message = message_of(*wire::GetEnvelope(head), read);
  if (!message) return message;
  if (read.error()) return std::unexpected(*read.error());
  return message;
}

}  // namespace

std::expected<Decoded, MessageError> decode(std::span<const std::byte> bytes) {
  if (bytes.size() > kOutboundMessageBytesMax) return std::unexpected(MessageError::kTooLarge);
  if (bytes.size() < kPrefixBytes) return std::unexpected(MessageError::kTooShort);
  std::uint32_t head_bytes = 0;
  for (std::size_t i = 0; i < kPrefixBytes; ++i) head_bytes |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
  if (head_bytes > kHeadBytesMax) return std::unexpected(MessageError::kTooLarge);
  if (head_bytes > bytes.size() - kPrefixBytes) return std::unexpected(MessageError::kTooShort);

  // The prefix leaves the head four bytes off its alignment: a small head moves to the stack, a large one to the heap.
  std::expected<Message, MessageError> message = std::unexpected(MessageError::kMalformed);
  const std::span<const std::byte> head = bytes.subspan(kPrefixBytes, head_bytes);
  if (head.size() <= 512) {
    alignas(8) std::array<std::uint8_t, 512> copy{};
    std::memcpy(copy.data(), head.data(), head.size());
    message = head_of(copy.data(), head.size());
  } else {
    std::vector<std::uint64_t> copy((head.size() + 7) / 8);
    std::memcpy(copy.data(), head.data(), head.size());
    message = head_of(reinterpret_cast<const std::uint8_t*>(copy.data()), head.size());
  }
  if (!message) return std::unexpected(message.error());

  const std::span<const std::byte> payload = bytes.subspan(kPrefixBytes + head_bytes);
  const auto* chunk = std::get_if<ChunkHead>(&*message);
  const auto* strip = std::get_if<StripHead>(&*message);
  const std::size_t declared = chunk != nullptr ? chunk->payload_bytes : strip != nullptr ? strip->payload_bytes : 0;
  if (payload.size() < declared) return std::unexpected(MessageError::kTooShort);
  if (payload.size() > declared) return std::unexpected(MessageError::kMalformed);
  return Decoded{std::move(*message), payload};
}

}  // namespace talus::protocol
