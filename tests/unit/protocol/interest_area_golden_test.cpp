// tests/golden/interest_area.json: what every implementation of the interest area has to give, in whatever language.
// Written anew only with TALUS_WRITE_GOLDEN=1 in the environment.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <nlohmann/json.hpp>

#include "protocol/interest_area.hpp"

namespace talus::protocol {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct Golden {
  View view;
  WorldShape shape;
};

/// Few and small, so that the file stays readable; each differs from the others in one respect.
std::vector<Golden> goldens() {
  std::vector<Golden> out;
  const auto add = [&](glm::dvec3 position, double near_m, double far_m, double lod_bias, WorldShape shape = {}) {
    View view;
    view.position = position;
    view.near_m = near_m;
    view.far_m = far_m;
    view.lod_bias = lod_bias;
    out.push_back({clamped(view, shape), shape});
  };
  add({0, 0, 0}, 128, 400, 0);
  add({-1000.5, 310.25, 77.125}, 112, 600, 0);
  add({1.0e9 + 13, 250, -1.0e9 + 7}, 112, 600, 0);
  add({5, 2500, 5}, 112, 3000, 0);
  add({640, 96, -640}, 128, 5000, 2);
  add({12, 40, 12}, 16, 120, -1, {16, 0.5, {-300, 900}});
  add({100, 500, 100}, 230, 900, 0, {16, 4, {-1000, 4000}});
  add({0, -900, 0}, 112, 32768, 0, {32, 4, {-1000, 100}});
  add({0, 20'000, 0}, 128, 12'000, 0);
  return out;
}

OrderedJson json_of(const Golden& golden) {
  std::vector<ChunkKey> keys;
  interest_area(golden.view, golden.shape, keys);
  std::ranges::sort(keys);
  const auto vec = [](const auto& v, int n) {
    OrderedJson out = OrderedJson::array();
    for (int i = 0; i < n; ++i) out.push_back(v[i]);
    return out;
  };
  OrderedJson list = OrderedJson::array();
  for (const ChunkKey& key : keys) list.push_back({key.lod, key.x, key.y, key.z});
  return {{"shape",
           {{"cells", golden.shape.cells},
            {"voxel_m", golden.shape.voxel_m},
            {"height_range_m", vec(golden.shape.height_range_m, 2)}}},
          {"view",
           {{"position", vec(golden.view.position, 3)},
            {"near_m", golden.view.near_m},
            {"far_m", golden.view.far_m},
            {"lod_bias", golden.view.lod_bias}}},
          {"keys", list}};
}

/// One case to a line: a change shows as the lines it touches.
std::string file_text() {
  std::string out = "[\n";
  const std::vector<Golden> all = goldens();
  for (std::size_t i = 0; i < all.size(); ++i) out += json_of(all[i]).dump() + (i + 1 < all.size() ? ",\n" : "\n");
  return out + "]\n";
}

TEST(InterestAreaGolden, IsWhatTheFileSays) {
  const std::string path = std::string(TALUS_SOURCE_DIR) + "/tests/golden/interest_area.json";
  const char* write = std::getenv("TALUS_WRITE_GOLDEN");
  if (write != nullptr && std::string_view(write) == "1") std::ofstream(path) << file_text();
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ASSERT_FALSE(text.empty()) << path;
  EXPECT_EQ(text, file_text());
}

}  // namespace
}  // namespace talus::protocol
