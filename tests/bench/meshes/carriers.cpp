#include "tests/bench/meshes/carriers.hpp"

#include <bit>
#include <cstring>
#include <memory>

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <zstd.h>

#include "protocol/lattice_vertex.hpp"
#include "protocol/limits.hpp"
#include "protocol/meshopt_codec.hpp"

namespace talus::bench {
namespace {

using Bytes = std::vector<std::byte>;

/// What of Draco is varied beside speed.
struct DracoChoice {
  draco::MeshEncoderMethod method = draco::MESH_EDGEBREAKER_ENCODING;
  int speed = 7;
  int normal_bits = protocol::kNormalBits;  ///< 0: no normals
  bool has_material = true;
  bool has_ridge = true;
  int positions = draco::PREDICTION_UNDEFINED;  ///< prediction; undefined: what the speed implies
  int normals = draco::PREDICTION_UNDEFINED;
  int bytes = draco::PREDICTION_UNDEFINED;  ///< of materials and ridge map
};

void add_values(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data, std::int8_t components,
                const void* values, std::size_t count, std::size_t bytes_each) {
  auto attribute = std::make_unique<draco::PointAttribute>();
  attribute->Init(type, components, data, false, count);
  attribute->SetIdentityMapping();
  std::memcpy(attribute->GetAddress(draco::AttributeValueIndex(0)), values, count * bytes_each);
  mesh.AddAttribute(std::move(attribute));
}

Bytes draco_bytes(const SampleMesh& sample, const DracoChoice& choice) {
  const ChunkMesh& from = sample.mesh;
  draco::Mesh mesh;
  const std::size_t count = from.positions.size();
  mesh.set_num_points(static_cast<std::uint32_t>(count));
  for (std::size_t i = 0; i < from.indices.size(); i += 3) {
    mesh.AddFace({draco::PointIndex(from.indices[i]), draco::PointIndex(from.indices[i + 1]),
                  draco::PointIndex(from.indices[i + 2])});
  }
  std::vector<glm::vec3> metres;
  for (const glm::u16vec3& p : from.positions)
    metres.push_back(glm::vec3(p) * static_cast<float>(sample.lattice.step_m));
  add_values(mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, metres.data(), count, sizeof(glm::vec3));
  draco::ExpertEncoder encoder(mesh);
  if (choice.normal_bits > 0) {
    add_values(mesh, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3, from.normals.data(), count,
               sizeof(glm::vec3));
    encoder.SetAttributeQuantization(1, choice.normal_bits);
  }
  if (choice.has_material) {
    add_values(mesh, draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 1, from.materials.data(), count, 1);
  }
  if (choice.has_ridge) {
    add_values(mesh, draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 1, from.ridges.data(), count, 1);
  }
  const int bits =
      static_cast<int>(std::bit_width(static_cast<unsigned>(sample.lattice.cells * kStepsPerCell - 1))) + 1;
  constexpr std::array<float, 3> kOrigin{};
  encoder.SetAttributeExplicitQuantization(
      0, bits, 3, kOrigin.data(), static_cast<float>((1 << bits) - 1) * static_cast<float>(sample.lattice.step_m));
  encoder.SetEncodingMethod(choice.method);
  encoder.SetSpeedOptions(choice.speed, choice.speed);
  for (int id = 0; id < mesh.num_attributes(); ++id) {
    const auto type = mesh.attribute(id)->attribute_type();
    const int prediction = type == draco::GeometryAttribute::POSITION ? choice.positions
                           : type == draco::GeometryAttribute::NORMAL ? choice.normals
                                                                      : choice.bytes;
    if (prediction != draco::PREDICTION_UNDEFINED) encoder.SetAttributePredictionScheme(id, prediction);
  }
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) return {};
  const auto* bytes = reinterpret_cast<const std::byte*>(buffer.data());
  return {bytes, bytes + buffer.size()};
}

Bytes zstd_bytes(const void* content, std::size_t bytes, int level) {
  Bytes out(ZSTD_compressBound(bytes));
  out.resize(ZSTD_compress(out.data(), out.size(), content, bytes, level));
  return out;
}

/// The protocol's payload with all behind its header in one zstd frame.
Bytes meshopt_zstd_bytes(const SampleMesh& sample, int level) {
  constexpr std::size_t kHeaderBytes = 24;
  const Bytes plain = *protocol::encode_meshopt(sample.mesh, sample.lattice);
  Bytes out(plain.begin(), plain.begin() + kHeaderBytes);
  const Bytes packed = zstd_bytes(plain.data() + kHeaderBytes, plain.size() - kHeaderBytes, level);
  out.insert(out.end(), packed.begin(), packed.end());
  return out;
}

/// Vertices of eight bytes and indices of 16 bits (32 where needed) in planes of bytes, packed.
Bytes raw_zstd_bytes(const SampleMesh& sample, int level) {
  const ChunkMesh& mesh = sample.mesh;
  const std::size_t count = mesh.positions.size();
  Bytes planes(count * sizeof(protocol::LatticeVertex));
  for (std::size_t v = 0; v < count; ++v) {
    const auto vertex = protocol::pack_vertex(mesh.positions[v], mesh.normals[v], mesh.materials[v], mesh.ridges[v]);
    const auto each = std::bit_cast<std::array<std::byte, sizeof vertex>>(vertex);
    for (std::size_t k = 0; k < each.size(); ++k) planes[k * count + v] = each[k];
  }
  const int index_bytes = count > 0xFFFF ? 4 : 2;
  for (int k = 0; k < index_bytes; ++k) {
    for (const std::uint32_t index : mesh.indices) planes.push_back(static_cast<std::byte>(index >> (8 * k)));
  }
  return zstd_bytes(planes.data(), planes.size(), level);
}

Carrier draco_carrier(std::string name, const DracoChoice& choice, bool is_whole) {
  return {std::move(name), is_whole ? "draco" : "",
          [choice](const SampleMesh& sample) { return draco_bytes(sample, choice); }};
}

}  // namespace

std::vector<Carrier> carriers() {
  std::vector<Carrier> out;
  for (const int speed : {0, 3, 5, 6, 7, 8, 9, 10}) {
    out.push_back({"Draco edgebreaker, speed " + std::to_string(speed), "draco", [speed](const SampleMesh& sample) {
                     return *protocol::encode_draco(sample.mesh, sample.lattice, speed);
                   }});
  }
  constexpr auto kEdgebreaker = draco::MESH_EDGEBREAKER_ENCODING;
  constexpr int kDifference = draco::PREDICTION_DIFFERENCE;
  constexpr int kParallelogram = draco::MESH_PREDICTION_PARALLELOGRAM;
  constexpr int kMany = draco::MESH_PREDICTION_CONSTRAINED_MULTI_PARALLELOGRAM;
  constexpr int kGeometric = draco::MESH_PREDICTION_GEOMETRIC_NORMAL;
  const auto predicted = [&](std::string name, int speed, int positions, int normals, int bytes) {
    out.push_back(
        draco_carrier(std::move(name), {kEdgebreaker, speed, 8, true, true, positions, normals, bytes}, true));
  };
  predicted("  7, places by differences", 7, kDifference, -1, -1);
  predicted("  10, places by parallelograms", 10, kParallelogram, kDifference, kDifference);
  predicted("  10, places by many parallelograms", 10, kMany, kDifference, kDifference);
  predicted("  4, all by differences", 4, kDifference, kDifference, kDifference);
  predicted("  0, all by differences", 0, kDifference, kDifference, kDifference);
  predicted("  10, normals by geometry", 10, kDifference, kGeometric, kDifference);
  predicted("  10, bytes as they are", 10, kDifference, kDifference, draco::PREDICTION_NONE);
  out.push_back(draco_carrier("Draco sequential, speed 7", {draco::MESH_SEQUENTIAL_ENCODING}, true));
  out.push_back(draco_carrier("  10, normals of 7 bits", {kEdgebreaker, 10, 7}, false));
  out.push_back(draco_carrier("  10, no normals", {kEdgebreaker, 10, 0}, false));
  out.push_back(draco_carrier("  10, no materials", {kEdgebreaker, 10, 8, false}, false));
  out.push_back(draco_carrier("  10, no ridge map", {kEdgebreaker, 10, 8, true, false}, false));
  out.push_back(draco_carrier("  10, places only", {kEdgebreaker, 10, 0, false, false}, false));
  out.push_back({"meshoptimizer", "mesh",
                 [](const SampleMesh& sample) { return *protocol::encode_meshopt(sample.mesh, sample.lattice); }});
  for (const int level : {1, 3, 9}) {
    out.push_back({"meshoptimizer + zstd " + std::to_string(level), "mesh+zstd",
                   [level](const SampleMesh& sample) { return meshopt_zstd_bytes(sample, level); }});
  }
  for (const int level : {1, 9}) {
    out.push_back({"planes + zstd " + std::to_string(level), "",
                   [level](const SampleMesh& sample) { return raw_zstd_bytes(sample, level); }});
  }
  return out;
}

}  // namespace talus::bench
