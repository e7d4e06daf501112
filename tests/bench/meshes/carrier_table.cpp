#include "tests/bench/meshes/carrier_table.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/bench/meshes/carriers.hpp"
#include "tests/bench/meshes/cpu_time.hpp"

namespace talus::bench {
namespace {

void write_file(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

void print_carriers(const TerrainSample& sample, const std::string& folder) {
  std::size_t triangles = 0;
  for (const SampleMesh& each : sample.meshes) triangles += each.mesh.triangles();
  std::printf("%s: %zu meshes, %zu triangles\n  %-32s %10s %10s %14s %9s\n", sample.name.c_str(), sample.meshes.size(),
              triangles, "carrier", "B/triangle", "kB/km2", "us to encode", "strips %");
  std::size_t number = 0;
  for (const Carrier& carrier : carriers()) {
    const std::filesystem::path into = std::filesystem::path(folder) / std::to_string(number++);
    if (!folder.empty() && !carrier.decoder.empty()) {
      std::filesystem::create_directories(into);
      std::ofstream(into / "carrier") << carrier.decoder << '\n' << carrier.name << '\n';
    }
    std::size_t bytes = 0;
    std::size_t strip_bytes = 0;
    CpuTime encoding;
    for (std::size_t i = 0; i < sample.meshes.size(); ++i) {
      const SampleMesh& each = sample.meshes[i];
      encoding.start();
      const std::vector<std::byte> payload = carrier.encode(each);
      encoding.stop();
      bytes += payload.size();
      if (each.is_strip) strip_bytes += payload.size();
      if (!folder.empty() && !carrier.decoder.empty()) write_file(into / (std::to_string(i) + ".bin"), payload);
    }
    const auto total = static_cast<double>(bytes);
    std::printf("  %-32s %10.3f ", carrier.name.c_str(), total / static_cast<double>(triangles));
    sample.area_km2 > 0.0 ? std::printf("%10.1f", total * 1e-3 / sample.area_km2) : std::printf("%10s", "");
    std::printf(" %14.0f %9.1f\n", encoding.seconds() * 1e6 / static_cast<double>(sample.meshes.size()),
                100.0 * static_cast<double>(strip_bytes) / total);
  }
}

}  // namespace talus::bench
