// Values -> bytes of messages. Pure.
#include <cstring>
#include <utility>

#include "core/base/check.hpp"
#include "protocol/limits.hpp"
#include "protocol/message.hpp"
#include "talus_generated.h"

namespace talus::protocol {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

wire::Key wire_key(const ChunkKey& key) {
  return {key.lod, key.x, key.y, key.z};
}
wire::Vec3 wire_vec(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Offset<flatbuffers::Vector<const wire::HeldKey*>> wire_held(FlatBufferBuilder& builder,
                                                            const std::vector<HeldChunk>& chunks) {
  // By a filler: flatc 2.0.8's uninitialised vectors of structs are not aligned.
  const auto fill = [&](std::size_t i, wire::HeldKey* out) {
    *out = wire::HeldKey(wire_key(chunks[i].key), chunks[i].revision);
  };
  return builder.CreateVectorOfStructs<wire::HeldKey>(chunks.size(), fill);
}

Offset<flatbuffers::Vector<const wire::StripKey*>> wire_strips(FlatBufferBuilder& builder,
                                                               const std::vector<StripKey>& strips) {
  const auto fill = [&](std::size_t i, wire::StripKey* out) {
    *out = wire::StripKey(wire_key(strips[i].key), static_cast<std::int32_t>(strips[i].face));
  };
  return builder.CreateVectorOfStructs<wire::StripKey>(strips.size(), fill);
}

/// Writes one message of the union and names its type; one overload for each.
struct UnionWriter {
  using Written = std::pair<wire::Message, Offset<void>>;
  FlatBufferBuilder& builder;

  Written operator()(const Hello& m) const {
    std::vector<Offset<flatbuffers::String>> formats;
    for (const std::string& format : m.formats) formats.push_back(builder.CreateString(format));
    const auto world = builder.CreateString(m.world);
    const auto token = builder.CreateString(m.token);
    const auto list = builder.CreateVector(formats);
    const auto client = builder.CreateString(m.client);
    return {
        wire::Message::Hello,
        wire::CreateHello(builder, m.version_low, m.version_high, world, token, list, m.credit_bytes, client).Union()};
  }
  Written operator()(const Welcome& m) const {
    const auto session = builder.CreateString(m.session);
    const auto hash = builder.CreateString(m.world_hash);
    const auto format = builder.CreateString(m.format);
    const auto manifest = builder.CreateString(m.manifest_json);
    return {wire::Message::Welcome, wire::CreateWelcome(builder, m.version, session, hash, format, manifest).Union()};
  }
  Written operator()(const Refused& m) const {
    const auto message = builder.CreateString(m.message);
    const auto versions = builder.CreateVector(m.versions);
    return {wire::Message::Refused,
            wire::CreateRefused(builder, static_cast<wire::RefusedReason>(m.reason), message, versions).Union()};
  }
  Written operator()(const ViewMessage& m) const {
    const wire::Vec3 position = wire_vec(m.view.position);
    const wire::Vec3 direction = wire_vec(m.view.direction);
    const wire::Vec3 velocity = wire_vec(m.view.velocity);
    return {wire::Message::View, wire::CreateView(builder, m.sequence, &position, &direction, &velocity, m.view.near_m,
                                                  m.view.far_m, m.view.lod_bias)
                                     .Union()};
  }
  Written operator()(const ViewAccepted& m) const {
    const wire::Vec3 position = wire_vec(m.view.position);
    return {wire::Message::ViewAccepted, wire::CreateViewAccepted(builder, m.sequence, &position, m.view.near_m,
                                                                  m.view.far_m, m.view.lod_bias, m.chunks)
                                             .Union()};
  }
  Written operator()(const Held& m) const {
    TALUS_CHECK(m.chunks.size() + m.strips.size() <= kKeysPerMessageMax && m.faces.size() <= m.chunks.size());
    const auto chunks = wire_held(builder, m.chunks);
    const auto faces = m.faces.empty() ? 0 : builder.CreateVector(m.faces);
    const auto strips = m.strips.empty() ? 0 : wire_strips(builder, m.strips);
    return {wire::Message::Held, wire::CreateHeld(builder, chunks, faces, strips).Union()};
  }
  Written operator()(const Want& m) const {
    TALUS_CHECK(m.chunks.size() + m.strips.size() <= kKeysPerMessageMax);
    const auto chunks = wire_held(builder, m.chunks);
    const auto strips = m.strips.empty() ? 0 : wire_strips(builder, m.strips);
    return {wire::Message::Want, wire::CreateWant(builder, chunks, strips).Union()};
  }
  Written operator()(const ChunkHead& m) const {
    TALUS_CHECK((m.kind == ChunkKind::kMesh) == (m.payload_bytes != 0));
    TALUS_CHECK(m.payload_bytes <= kOutboundMessageBytesMax - kChunkHeadBytesMax);
    const wire::Key key = wire_key(m.key);
    return {wire::Message::Chunk,
            wire::CreateChunk(builder, &key, m.revision, static_cast<wire::ChunkKind>(m.kind), m.payload_bytes, m.faces)
                .Union()};
  }
  Written operator()(const StripHead& m) const {
    TALUS_CHECK(m.payload_bytes <= kOutboundMessageBytesMax - kChunkHeadBytesMax);
    const wire::Key key = wire_key(m.strip.key);
    return {
        wire::Message::Strip,
        wire::CreateStrip(builder, &key, static_cast<std::uint8_t>(m.strip.face), m.revision, m.payload_bytes).Union()};
  }
  Written operator()(const Failed& m) const {
    const wire::Key key = wire_key(m.key);
    const auto face = m.face ? static_cast<std::int8_t>(*m.face) : std::int8_t{-1};
    return {wire::Message::Failed, wire::CreateFailed(builder, &key, face).Union()};
  }
  Written operator()(const Leave& m) const {
    TALUS_CHECK(m.keys.size() <= kKeysPerMessageMax);
    const auto fill = [&](std::size_t i, wire::Key* out) { *out = wire_key(m.keys[i]); };
    const auto keys = builder.CreateVectorOfStructs<wire::Key>(m.keys.size(), fill);
    return {wire::Message::Leave, wire::CreateLeave(builder, keys).Union()};
  }
  Written operator()(const Idle& m) const {
    return {wire::Message::Idle, wire::CreateIdle(builder, m.view_sequence, m.chunks_sent).Union()};
  }
  Written operator()(const Credit& m) const {
    return {wire::Message::Credit, wire::CreateCredit(builder, m.bytes).Union()};
  }
  Written operator()(const Ping& m) const { return {wire::Message::Ping, wire::CreatePing(builder, m.nonce).Union()}; }
  Written operator()(const Pong& m) const { return {wire::Message::Pong, wire::CreatePong(builder, m.nonce).Union()}; }
  Written operator()(const Bye& m) const {
    const auto message = builder.CreateString(m.message);
    return {wire::Message::Bye, wire::CreateBye(builder, static_cast<wire::ByeReason>(m.reason), message).Union()};
  }
};

}  // namespace

std::vector<std::byte> encode(const Message& message) {
  FlatBufferBuilder builder(256);
  const auto [type, offset] = std::visit(UnionWriter{builder}, message);
  builder.Finish(wire::CreateEnvelope(builder, type, offset));

  const std::uint32_t head_bytes = builder.GetSize();
  std::vector<std::byte> out(kPrefixBytes + head_bytes);
  for (std::size_t i = 0; i < kPrefixBytes; ++i) out[i] = static_cast<std::byte>(head_bytes >> (8 * i));
  std::memcpy(out.data() + kPrefixBytes, builder.GetBufferPointer(), head_bytes);
  return out;
}

}  // namespace talus::protocol
