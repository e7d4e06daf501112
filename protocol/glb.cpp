// ChunkMesh -> glTF 2.0 binary. Based on: Khronos, glTF 2.0 specification, and KHR_draco_mesh_compression. Pure.
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
constexpr int kSpeed = 7;

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

Json asset_json() {
  return {{"asset", {{"version", "2.0"}, {"generator", "talus"}}}, {"scene", 0}};
}

Json chunk_json(const ColouredDraco& payload, const MeshLattice& lattice, const glm::dvec3& translation_m) {
  Json out = asset_json();
  out["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  out["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  out["scenes"] = {{{"nodes", {0}}}};
  out["nodes"] = {{{"mesh", 0}, {"translation", {translation_m.x, translation_m.y, translation_m.z}}}};
  const Json primitive{
      {"attributes", {{"POSITION", 1}, {"NORMAL", 2}, {"COLOR_0", 3}, {"_MATERIAL", 4}, {"_RIDGE", 5}}},
      {"indices", 0},
      {"mode", kTriangles},
      {"material", 0},
      {"extensions",
       {{"KHR_draco_mesh_compression",
         {{"bufferView", 0},
          {"attributes",
           {{"POSITION", 0},
            {"NORMAL", 1},
            {"COLOR_0", kDracoColourId},
            {"_MATERIAL", kDracoMaterialId},
            {"_RIDGE", kDracoRidgeId}}}}}}}};
  out["meshes"] = Json::array({{{"primitives", Json::array({primitive})}}});
  out["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
  const auto accessor = [](int component, std::size_t count, const char* type) {
    return Json{{"componentType", component}, {"count", count}, {"type", type}};
  };
  Json position = accessor(kFloat, payload.vertices, "VEC3");
  position["min"] = metres(payload.low, lattice);
  position["max"] = metres(payload.high, lattice);
  Json colour = accessor(kUnsignedShort, payload.vertices, "VEC3");
  colour["normalized"] = true;
  out["accessors"] = Json::array({accessor(kUnsignedInt, 3 * payload.triangles, "SCALAR"), position,
                                  accessor(kFloat, payload.vertices, "VEC3"), colour,
                                  accessor(kUnsignedByte, payload.vertices, "SCALAR"),
                                  accessor(kUnsignedByte, payload.vertices, "SCALAR")});
  out["bufferViews"] = {{{"buffer", 0}, {"byteLength", payload.bytes.size()}}};
  out["buffers"] = {{{"byteLength", payload.bytes.size()}}};
  return out;
}

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

std::expected<std::vector<std::byte>, CodecError> encode_glb(const ChunkMesh& mesh, const MeshLattice& lattice,
                                                             const glm::dvec3& translation_m) {
  TALUS_CHECK(std::isfinite(translation_m.x) && std::isfinite(translation_m.y) && std::isfinite(translation_m.z));
  if (mesh.indices.empty()) {
    Json empty = asset_json();
    empty["scenes"] = Json::array({Json::object()});
    return container(empty, {});
  }
  static const std::array<glm::u16vec3, kMaterials.size()> kPalette = linear_palette();
  const auto payload = encode_coloured_draco(mesh, lattice, kPalette, kSpeed);
  if (!payload) return std::unexpected(payload.error());
  return container(chunk_json(*payload, lattice, translation_m), payload->bytes);
}

}  // namespace talus::protocol
