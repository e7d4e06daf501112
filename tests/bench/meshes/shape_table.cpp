#include "tests/bench/meshes/shape_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <span>

#include <meshoptimizer.h>
#include <glm/geometric.hpp>

#include "tests/bench/meshes/cpu_time.hpp"

namespace talus::bench {
namespace {

constexpr unsigned kCache = 16;  ///< vertices of a small first-in first-out cache

/// Smallest angle of a triangle in degrees.
double least_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  double out = 180.0;
  for (const auto& [at, to, other] : {std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}}) {
    const glm::dvec3 u = to - at;
    const glm::dvec3 v = other - at;
    out = std::min(out, std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)) * 180.0 / std::numbers::pi);
  }
  return out;
}

struct Shapes {
  std::size_t triangles = 0;
  std::size_t vertices = 0;
  std::array<std::size_t, 4> thinner{};  ///< than 1, 2, 5, 10 degrees
  std::size_t misses = 0;

  void add(const ChunkMesh& mesh) {
    static constexpr std::array<double, 4> kDegrees{1.0, 2.0, 5.0, 10.0};
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const double angle =
          least_angle(glm::dvec3(mesh.positions[mesh.indices[i]]), glm::dvec3(mesh.positions[mesh.indices[i + 1]]),
                      glm::dvec3(mesh.positions[mesh.indices[i + 2]]));
      for (std::size_t k = 0; k < kDegrees.size(); ++k) thinner[k] += angle < kDegrees[k] ? 1U : 0U;
    }
    triangles += mesh.triangles();
    vertices += mesh.positions.size();
    misses += meshopt_analyzeVertexCache(mesh.indices.data(), mesh.indices.size(), mesh.positions.size(), kCache, 0, 0)
                  .vertices_transformed;
  }
};

/// Appends the triangles of `indices`, simplified within `error` steps; what has a border keeps it.
void append_simplified(const std::vector<glm::vec3>& steps, const std::vector<unsigned>& indices, float error,
                       std::vector<unsigned>& out) {
  if (indices.empty()) return;
  const float scale = meshopt_simplifyScale(&steps[0].x, steps.size(), sizeof(glm::vec3));
  const std::size_t before = out.size();
  out.resize(before + indices.size());
  out.resize(before + meshopt_simplify(out.data() + before, indices.data(), indices.size(), &steps[0].x, steps.size(),
                                       sizeof(glm::vec3), 0, error / scale, meshopt_SimplifyLockBorder, nullptr));
}

/// `mesh` with the inside of each patch of one material simplified: borders of chunks and of materials stay.
ChunkMesh simplified(const ChunkMesh& mesh, float error) {
  std::map<std::uint8_t, std::vector<unsigned>> patches;
  ChunkMesh out = mesh;
  out.indices.clear();
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corners = std::span(mesh.indices).subspan(i, 3);
    const std::uint8_t material = mesh.materials[corners[0]];
    const bool is_mixed = mesh.materials[corners[1]] != material || mesh.materials[corners[2]] != material;
    std::vector<unsigned>& into = is_mixed ? out.indices : patches[material];
    into.insert(into.end(), corners.begin(), corners.end());
  }
  const std::vector<glm::vec3> steps(mesh.positions.begin(), mesh.positions.end());
  for (const auto& [material, indices] : patches) append_simplified(steps, indices, error, out.indices);

  std::vector<unsigned> remap(mesh.positions.size());
  const std::size_t kept =
      meshopt_optimizeVertexFetchRemap(remap.data(), out.indices.data(), out.indices.size(), remap.size());
  meshopt_remapIndexBuffer(out.indices.data(), out.indices.data(), out.indices.size(), remap.data());
  for (std::size_t v = 0; v < remap.size(); ++v) {
    if (remap[v] == ~0U) continue;
    out.positions[remap[v]] = mesh.positions[v];
    out.normals[remap[v]] = mesh.normals[v];
    out.materials[remap[v]] = mesh.materials[v];
    out.ridges[remap[v]] = mesh.ridges[v];
  }
  out.positions.resize(kept);
  out.normals.resize(kept);
  out.materials.resize(kept);
  out.ridges.resize(kept);
  return out;
}

void print_row(const char* name, const Shapes& shapes) {
  std::printf("  %-28s %9zu %7.3f %9zu %9zu %9zu %9zu %6.2f\n", name, shapes.triangles,
              static_cast<double>(shapes.triangles) / static_cast<double>(shapes.vertices), shapes.thinner[0],
              shapes.thinner[1], shapes.thinner[2], shapes.thinner[3],
              static_cast<double>(shapes.misses) / static_cast<double>(shapes.triangles));
}

/// What simplifying saves of triangles and bytes, and what it costs beside the encoder.
void print_simplification(const TerrainSample& sample) {
  std::size_t triangles = 0;
  std::size_t bytes = 0;
  double encoding_s = 0.0;
  for (const float error : {0.0F, 0.5F, 1.0F, 2.0F, 4.0F}) {
    std::size_t left_bytes = 0;
    Shapes left;
    CpuTime simplifying;
    CpuTime encoding;
    for (const SampleMesh& each : sample.meshes) {
      if (each.is_strip) continue;
      simplifying.start();
      const ChunkMesh mesh = error > 0.0F ? simplified(each.mesh, error) : each.mesh;
      simplifying.stop();
      left.add(mesh);
      encoding.start();
      left_bytes += protocol::encode_draco(mesh, each.lattice)->size();
      encoding.stop();
    }
    if (error == 0.0F) {
      triangles = left.triangles;
      bytes = left_bytes;
      encoding_s = encoding.seconds();
      continue;
    }
    const auto percent = [](double part, double whole) { return 100.0 * part / whole; };
    std::printf(
        "  simplified within %.1f/64 cell: %5.1f %% of triangles (%.1f %% thinner than 5 deg), %5.1f %% of bytes; "
        "takes %.0f %% of Draco's time, leaves %.0f %% of it\n",
        static_cast<double>(error), percent(static_cast<double>(left.triangles), static_cast<double>(triangles)),
        percent(static_cast<double>(left.thinner[2]), static_cast<double>(left.triangles)),
        percent(static_cast<double>(left_bytes), static_cast<double>(bytes)),
        percent(simplifying.seconds(), encoding_s), percent(encoding.seconds(), encoding_s));
  }
}

}  // namespace

void print_shapes(const TerrainSample& sample) {
  std::printf("%s\n  %-28s %9s %7s %9s %9s %9s %9s %6s\n", sample.name.c_str(), "triangles thinner than", "triangles",
              "/vertex", "1 deg", "2 deg", "5 deg", "10 deg", "ACMR");
  for (const bool is_strip : {false, true}) {
    Shapes made;
    Shapes decoded;
    for (const SampleMesh& each : sample.meshes) {
      if (each.is_strip != is_strip) continue;
      made.add(each.mesh);
      decoded.add(*protocol::decode_draco(*protocol::encode_draco(each.mesh, each.lattice), each.lattice));
    }
    if (made.triangles == 0) continue;
    print_row(is_strip ? "strips as made" : "chunks as made", made);
    print_row(is_strip ? "strips from Draco" : "chunks from Draco", decoded);
  }
  print_simplification(sample);
}

}  // namespace talus::bench
