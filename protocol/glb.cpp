// Chunk meshes -> glTF 2.0 binary. Based on: Khronos, glTF 2.0 specification, and KHR_draco_mesh_compression. Pure.
#include <array>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "core/base/check.hpp"
#include "core/strata/material.hpp"
#include "protocol/coloured_draco.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::protocol {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kTriangles = 4;

/// glTF colours of vertices are linear; our palette is sRGB. IEC 61966-2-1.
std::uint16_t linear_of(std::uint32_t srgb) {
  const double v = srgb / 255.0;
  const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(linear * 65535.0));
}

std::array<glm::u16vec3, kMaterials.size()> linear_palette() {
  std::array<glm::u16vec3, kMaterials.size()> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint32_t rgb = kMaterials[i].colour_rgb;
    out[i] = {linear_of(rgb >> 16 & 0xFF), linear_of(rgb >> 8 & 0xFF), linear_of(rgb & 0xFF)};
  }
  return out;
}

Json metres(const glm::u16vec3& steps, const MeshLattice& lattice) {
  return {steps.x * lattice.step_m, steps.y * lattice.step_m, steps.z * lattice.step_m};
}

Json accessor_json(int component, std::size_t count, const char* type) {
  return {{"componentType", component}, {"count", count}, {"type", type}};
}

/// The JSON of an asset, and its binary part: one Draco buffer after the other.
class Asset {
 public:
  explicit Asset(const ChunkKey& key) : key_(key) {}

  void add(const ColouredDraco& payload, const GlbPart& part) {
    const std::size_t view = views_.size();
    const std::size_t begin = binary_.size();
    binary_.insert(binary_.end(), payload.bytes.begin(), payload.bytes.end());
    binary_.resize((binary_.size() + 3) / 4 * 4);
    views_.push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", payload.bytes.size()}});
    meshes_.push_back({{"primitives", Json::array({primitive(view)})}});
    nodes_.push_back({{"mesh", view},
                      {"translation", {part.translation_m.x, part.translation_m.y, part.translation_m.z}},
                      {"extras", {{"lod", key_.lod}, {"x", key_.x}, {"y", key_.y}, {"z", key_.z}}}});
    add_accessors(payload, part.lattice);
  }

  Json json() const {
    Json out{{"asset", {{"version", "2.0"}, {"generator", "talus"}}}, {"scene", 0}};
    if (nodes_.empty()) {
      out["scenes"] = Json::array({Json::object()});
      return out;
    }
    Json roots = Json::array();
    for (std::size_t i = 0; i < nodes_.size(); ++i) roots.push_back(i);
    out["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    out["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    out["scenes"] = {{{"nodes", roots}}};
    out["nodes"] = nodes_;
    out["meshes"] = meshes_;
    out["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
    out["accessors"] = accessors_;
    out["bufferViews"] = views_;
    out["buffers"] = {{{"byteLength", binary_.size()}}};
    return out;
  }

  std::span<const std::byte> binary() const { return binary_; }

 private:
  Json primitive(std::size_t view) const {
    const std::size_t first = accessors_.size();
    return {{"attributes",
             {{"POSITION", first + 1},
              {"NORMAL", first + 2},
              {"COLOR_0", first + 3},
              {"_MATERIAL", first + 4},
              {"_RIDGE", first + 5}}},
            {"indices", first},
            {"mode", kTriangles},
            {"material", 0},
            {"extensions",
             {{"KHR_draco_mesh_compression",
               {{"bufferView", view},
                {"attributes",
                 {{"POSITION", 0},
                  {"NORMAL", 1},
                  {"COLOR_0", kDracoColourId},
                  {"_MATERIAL", kDracoMaterialId},
                  {"_RIDGE", kDracoRidgeId}}}}}}}};
  }

  void add_accessors(const ColouredDraco& payload, const MeshLattice& lattice) {
    Json position = accessor_json(kFloat, payload.vertices, "VEC3");
    position["min"] = metres(payload.low, lattice);
    position["max"] = metres(payload.high, lattice);
    Json colour = accessor_json(kUnsignedShort, payload.vertices, "VEC3");
    colour["normalized"] = true;
    for (Json& one : std::array<Json, 6>{accessor_json(kUnsignedInt, 3 * payload.triangles, "SCALAR"), position,
                                         accessor_json(kFloat, payload.vertices, "VEC3"), colour,
                                         accessor_json(kUnsignedByte, payload.vertices, "SCALAR"),
                                         accessor_json(kUnsignedByte, payload.vertices, "SCALAR")}) {
      accessors_.push_back(std::move(one));
    }
  }

  ChunkKey key_;
  Json nodes_ = Json::array();
  Json meshes_ = Json::array();
  Json accessors_ = Json::array();
  Json views_ = Json::array();
  std::vector<std::byte> binary_;
};

void put_u32(std::vector<std::byte>& out, std::size_t value) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i)));
}

/// One chunk of a GLB: length, type, bytes, padding to four.
void put_chunk(std::vector<std::byte>& out, std::uint32_t type, std::span<const std::byte> bytes, std::byte padding) {
  const std::size_t padded = (bytes.size() + 3) / 4 * 4;
  put_u32(out, padded);
  put_u32(out, type);
  out.insert(out.end(), bytes.begin(), bytes.end());
  out.insert(out.end(), padded - bytes.size(), padding);
}

std::vector<std::byte> container(const Json& json, std::span<const std::byte> binary) {
  constexpr std::uint32_t kMagic = 0x46546C67;   // "glTF"
  constexpr std::uint32_t kJson = 0x4E4F534A;    // "JSON"
  constexpr std::uint32_t kBinary = 0x004E4942;  // "BIN"
  const std::string text = json.dump();
  std::vector<std::byte> body;
  put_chunk(body, kJson, std::as_bytes(std::span(text)), std::byte{' '});
  if (!binary.empty()) put_chunk(body, kBinary, binary, std::byte{0});
  std::vector<std::byte> out;
  put_u32(out, kMagic);
  put_u32(out, 2);
  put_u32(out, 12 + body.size());
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

}  // namespace

std::expected<std::vector<std::byte>, CodecError> encode_glb(std::span<const GlbPart> parts, const ChunkKey& key) {
  static const std::array<glm::u16vec3, kMaterials.size()> kPalette = linear_palette();
  Asset asset(key);
  for (const GlbPart& part : parts) {
    const glm::dvec3& at = part.translation_m;
    TALUS_CHECK(std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z));
    if (part.mesh.indices.empty()) continue;
    const auto payload = encode_coloured_draco(part.mesh, part.lattice, kPalette);
    if (!payload) return std::unexpected(payload.error());
    asset.add(*payload, part);
  }
  return container(asset.json(), asset.binary());
}

std::expected<std::vector<std::byte>, CodecError> encode_chunk_glb(const ChunkMesh& mesh, const ChunkKey& key,
                                                                   int cells, double voxel_m,
                                                                   const glm::dvec3& origin_m) {
  const GlbPart part{mesh, mesh_lattice(key, cells, voxel_m), box_of(key, cells, voxel_m).low - origin_m};
  return encode_glb(std::span(&part, 1), key);
}

}  // namespace talus::protocol
