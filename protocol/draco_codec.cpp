// ChunkMesh <-> Draco. Encoding trusts its mesh; decoding trusts nothing: every count that Draco would allocate for is
// read and bounded first, and a result off the lattice is malformed.
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>

#include <draco/compression/expert_encode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <glm/common.hpp>

#include "core/base/check.hpp"
#include "core/mesh/seam_cell.hpp"
#include "protocol/coloured_draco.hpp"
#include "protocol/limits.hpp"
#include "protocol/mesh_codec.hpp"

namespace talus::protocol {
namespace {

/// Attributes in the order they are added, which makes these their unique ids.
enum AttributeId : int { kPosition, kNormal, kMaterial, kRidge, kAttributes, kColour = kAttributes };
static_assert(kMaterial == kDracoMaterialId && kRidge == kDracoRidgeId && kColour == kDracoColourId);

/// Steps fit in 16 bits. A world has at most 32 cells a chunk; a strip has those of the next finer LOD, and a tile of a
/// column stacks them.
constexpr int kCellsMax = 0xFFFF / kStepsPerCell;
/// Marching cubes makes at most 5 triangles a cell.
constexpr std::size_t kCellTrianglesMax = 5;

bool is_power_of_two(double v) {
  int exponent = 0;
  return std::isfinite(v) && v > 0 && std::frexp(v, &exponent) == 0.5;
}

/// Steps per chunk edge.
int steps_of(const MeshLattice& lattice) {
  return lattice.cells * kStepsPerCell;
}

/// One bit more than log2(steps), so that the last step, `steps` itself, has a code.
int position_bits(const MeshLattice& lattice) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(steps_of(lattice) - 1))) + 1;
}

/// The range at which Draco's quantisation step is exactly step_m: a round range would match no vertex of a neighbour.
float position_range(const MeshLattice& lattice) {
  return static_cast<float>((1 << position_bits(lattice)) - 1) * static_cast<float>(lattice.step_m);
}

/// Adds an attribute with one value per point; returns where its values go.
std::uint8_t* add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data,
                            std::int8_t components, std::size_t values) {
  auto attribute = std::make_unique<draco::PointAttribute>();
  attribute->Init(type, components, data, false, values);
  attribute->SetIdentityMapping();
  const int id = mesh.AddAttribute(std::move(attribute));
  return mesh.attribute(id)->GetAddress(draco::AttributeValueIndex(0));
}

void fill(draco::Mesh& out, const ChunkMesh& mesh, const MeshLattice& lattice) {
  const std::size_t vertices = mesh.positions.size();
  out.set_num_points(static_cast<std::uint32_t>(vertices));
  out.SetNumFaces(mesh.triangles());
  for (std::size_t i = 0; i < mesh.triangles(); ++i) {
    const std::uint32_t* corner = mesh.indices.data() + 3 * i;
    out.SetFace(draco::FaceIndex(static_cast<std::uint32_t>(i)),
                {draco::PointIndex(corner[0]), draco::PointIndex(corner[1]), draco::PointIndex(corner[2])});
  }
  const auto step = static_cast<float>(lattice.step_m);
  std::uint8_t* positions = add_attribute(out, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    // Exact: at most 16 bits times a power of two.
    const glm::vec3 metres = glm::vec3(mesh.positions[i]) * step;
    std::memcpy(positions + i * sizeof metres, &metres, sizeof metres);
  }
  std::uint8_t* normals = add_attribute(out, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3, vertices);
  std::memcpy(normals, mesh.normals.data(), vertices * sizeof(glm::vec3));
  std::memcpy(add_attribute(out, draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 1, vertices),
              mesh.materials.data(), vertices);
  std::memcpy(add_attribute(out, draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 1, vertices), mesh.ridges.data(),
              vertices);
}

/// Draco's decoder with a door between reading what a mesh declares and allocating for it.
class BoundedDecoder final : public draco::MeshEdgebreakerDecoder {
 public:
  explicit BoundedDecoder(std::size_t points_max) : points_max_(points_max) {}

 protected:
  bool DecodeAllAttributes() override {
    static constexpr std::array<draco::GeometryAttribute::Type, kAttributes> kTypes{
        draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL, draco::GeometryAttribute::GENERIC,
        draco::GeometryAttribute::GENERIC};
    const draco::PointCloud& cloud = *point_cloud();
    if (cloud.num_points() > points_max_ || cloud.num_attributes() != kAttributes) return false;
    for (int id = 0; id < kAttributes; ++id) {
      const draco::PointAttribute& attribute = *cloud.attribute(id);
      const bool is_vector = id == kPosition || id == kNormal;
      if (attribute.unique_id() != static_cast<std::uint32_t>(id)) return false;
      if (attribute.attribute_type() != kTypes[static_cast<std::size_t>(id)]) return false;
      if (attribute.data_type() != (is_vector ? draco::DT_FLOAT32 : draco::DT_UINT8)) return false;
      if (attribute.num_components() != (is_vector ? 3 : 1)) return false;
    }
    return draco::MeshEdgebreakerDecoder::DecodeAllAttributes();
  }

 private:
  std::size_t points_max_;
};

/// Reads Draco's header and the counts behind it: version 2.2, a mesh, edgebreaker, no metadata, counts a chunk can
/// have.
bool counts_are_bounded(std::span<const std::byte> bytes, std::size_t triangles_max) {
  static constexpr std::array<std::uint8_t, 9> kHeader{
      'D', 'R', 'A', 'C', 'O', 2, 2, draco::TRIANGULAR_MESH, draco::MESH_EDGEBREAKER_ENCODING};
  if (bytes.size() < kHeader.size() || std::memcmp(bytes.data(), kHeader.data(), kHeader.size()) != 0) return false;
  draco::DecoderBuffer rest;
  rest.Init(reinterpret_cast<const char*>(bytes.data()) + kHeader.size(), bytes.size() - kHeader.size());
  rest.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  std::uint16_t flags = 0;
  std::uint8_t traversal = 0;
  std::uint8_t attribute_data = 0;
  std::uint32_t vertices = 0;
  std::uint32_t faces = 0;
  if (!rest.Decode(&flags) || flags != 0) return false;
  if (!rest.Decode(&traversal) || (traversal != draco::MESH_EDGEBREAKER_STANDARD_ENCODING &&
                                   traversal != draco::MESH_EDGEBREAKER_VALENCE_ENCODING)) {
    return false;
  }
  if (!draco::DecodeVarint(&vertices, &rest) || !draco::DecodeVarint(&faces, &rest) || !rest.Decode(&attribute_data)) {
    return false;
  }
  return faces > 0 && faces <= triangles_max && vertices <= 3 * faces && attribute_data <= kAttributes;
}

/// Steps of a coordinate in metres, or -1 off the lattice.
int steps_at(float metres, const MeshLattice& lattice) {
  const float steps = metres / static_cast<float>(lattice.step_m);
  if (!(steps >= 0.0F && steps <= static_cast<float>(steps_of(lattice)))) return -1;
  const int whole = static_cast<int>(steps);
  return static_cast<float>(whole) == steps ? whole : -1;
}

template <typename T>
void copy_values(const draco::PointAttribute& from, std::size_t points, std::vector<T>& out) {
  out.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    from.GetMappedValue(draco::PointIndex(static_cast<std::uint32_t>(i)), &out[i]);
  }
}

/// False when a position is off the lattice or a normal has no direction.
bool take(const draco::Mesh& mesh, const MeshLattice& lattice, ChunkMesh& out) {
  const std::size_t points = mesh.num_points();
  out.positions.resize(points);
  std::vector<glm::vec3> metres;
  copy_values(*mesh.attribute(kPosition), points, metres);
  for (std::size_t i = 0; i < points; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const int steps = steps_at(metres[i][axis], lattice);
      if (steps < 0) return false;
      out.positions[i][axis] = static_cast<std::uint16_t>(steps);
    }
  }
  copy_values(*mesh.attribute(kNormal), points, out.normals);
  for (glm::vec3& normal : out.normals) {
    const float length = std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
    if (!(length > 0.5F && length < 2.0F)) return false;
    normal /= length;
  }
  copy_values(*mesh.attribute(kMaterial), points, out.materials);
  copy_values(*mesh.attribute(kRidge), points, out.ridges);
  out.indices.reserve(3 * static_cast<std::size_t>(mesh.num_faces()));
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
      if (corner.value() >= points) return false;
      out.indices.push_back(corner.value());
    }
  }
  return true;
}

void check_encodable(const ChunkMesh& mesh, const MeshLattice& lattice, int speed) {
  TALUS_CHECK(lattice.cells > 0 && lattice.cells <= kCellsMax && is_power_of_two(lattice.step_m));
  TALUS_CHECK(mesh.normals.size() == mesh.positions.size() && mesh.materials.size() == mesh.positions.size() &&
              mesh.ridges.size() == mesh.positions.size());
  TALUS_CHECK(speed >= 0 && speed <= 10);
}

std::expected<std::vector<std::byte>, CodecError> compress(const draco::Mesh& staged, const MeshLattice& lattice,
                                                           int speed) {
  draco::ExpertEncoder encoder(staged);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetSpeedOptions(speed, speed);
  constexpr std::array<float, 3> kOrigin{};
  encoder.SetAttributeExplicitQuantization(kPosition, position_bits(lattice), 3, kOrigin.data(),
                                           position_range(lattice));
  encoder.SetAttributeQuantization(kNormal, kNormalBits);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) return std::unexpected(CodecError::kInternal);
  if (buffer.size() > kOutboundMessageBytesMax - kChunkHeadBytesMax) return std::unexpected(CodecError::kTooLarge);
  std::vector<std::byte> out(buffer.size());
  std::memcpy(out.data(), buffer.data(), buffer.size());
  return out;
}

}  // namespace

MeshLattice mesh_lattice(const ChunkKey& key, int cells, double voxel_m) {
  const auto edge = static_cast<std::size_t>(cells);
  return {cells, std::ldexp(voxel_m, key.lod) / kStepsPerCell, edge * edge * edge * kCellTrianglesMax};
}

MeshLattice strip_lattice(const ChunkKey& key, int cells, double voxel_m) {
  TALUS_CHECK(key.lod > 0);
  const auto edge = static_cast<std::size_t>(cells);
  return {2 * cells, std::ldexp(voxel_m, key.lod - 1) / kStepsPerCell, edge * edge * kSeamTrianglesMax};
}

std::expected<std::vector<std::byte>, CodecError> encode_draco(const ChunkMesh& mesh, const MeshLattice& lattice,
                                                               int speed) {
  check_encodable(mesh, lattice, speed);
  if (mesh.indices.empty()) return std::unexpected(CodecError::kEmpty);
  draco::Mesh staged;
  fill(staged, mesh, lattice);
  return compress(staged, lattice, speed);
}

std::expected<ColouredDraco, CodecError> encode_coloured_draco(const ChunkMesh& mesh, const MeshLattice& lattice,
                                                               std::span<const glm::u16vec3> palette) {
  check_encodable(mesh, lattice, kDracoSpeed);
  TALUS_CHECK(!palette.empty());
  if (mesh.indices.empty()) return std::unexpected(CodecError::kEmpty);
  draco::Mesh staged;
  fill(staged, mesh, lattice);
  std::uint8_t* colours =
      add_attribute(staged, draco::GeometryAttribute::COLOR, draco::DT_UINT16, 3, mesh.positions.size());
  for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
    const glm::u16vec3& colour = palette[mesh.materials[i] < palette.size() ? mesh.materials[i] : 0];
    std::memcpy(colours + i * sizeof colour, &colour, sizeof colour);
  }
  auto bytes = compress(staged, lattice, kDracoSpeed);
  if (!bytes) return std::unexpected(bytes.error());

  // Edgebreaker splits vertices that are not manifold and drops flat triangles: only a decoder knows what is left.
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  draco::Mesh decoded;
  draco::MeshEdgebreakerDecoder decoder;
  const draco::DecoderOptions options;
  ChunkMesh seen;
  if (!decoder.Decode(options, &buffer, &decoded).ok() || !take(decoded, lattice, seen) || seen.positions.empty()) {
    return std::unexpected(CodecError::kInternal);
  }
  ColouredDraco out{std::move(*bytes), seen.positions.size(), seen.triangles(), seen.positions[0], seen.positions[0]};
  for (const glm::u16vec3& position : seen.positions) {
    out.low = glm::min(out.low, position);
    out.high = glm::max(out.high, position);
  }
  return out;
}

std::expected<ChunkMesh, CodecError> decode_draco(std::span<const std::byte> bytes, const MeshLattice& lattice) {
  TALUS_CHECK(lattice.cells > 0 && lattice.cells <= kCellsMax && is_power_of_two(lattice.step_m));
  if (bytes.size() > kOutboundMessageBytesMax) return std::unexpected(CodecError::kTooLarge);
  if (!counts_are_bounded(bytes, lattice.triangles_max)) return std::unexpected(CodecError::kMalformed);
  // Draco reports most faults; those it meets as standard exceptions (a length that no vector has) are faults as well.
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Mesh mesh;
    BoundedDecoder decoder(3 * lattice.triangles_max);
    const draco::DecoderOptions options;
    if (!decoder.Decode(options, &buffer, &mesh).ok()) return std::unexpected(CodecError::kMalformed);
    ChunkMesh out;
    if (!take(mesh, lattice, out)) return std::unexpected(CodecError::kMalformed);
    return out;
  } catch (const std::exception&) {
    return std::unexpected(CodecError::kMalformed);
  }
}

}  // namespace talus::protocol
