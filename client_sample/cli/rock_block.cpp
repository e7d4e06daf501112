#include "client_sample/cli/rock_block.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace talus::cli {
namespace {

constexpr std::array<std::pair<int, int>, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
constexpr int kCellsMin = 12;
constexpr int kMouthMin = 3;
constexpr int kMouthLink = 2;

/// A layer of the block as the search sees it.
class Slice {
 public:
  Slice(const RockBlock& block, int y) : block_(block), y_(y), kind_(count(), kOpen), seen_(count(), 0) {
    for (int z = 0; z < block.depth; ++z) {
      for (int x = 0; x < block.width; ++x) {
        if (block.rock[block.at(x, y, z)] != 0) {
          kind_[cell(x, z)] = kRock;
          continue;
        }
        for (int up = y + 1; up < block.height && kind_[cell(x, z)] == kOpen; ++up)
          if (block.rock[block.at(x, up, z)] != 0) kind_[cell(x, z)] = kCovered;
      }
    }
  }

  std::vector<Cavity> cavities() {
    std::vector<Cavity> out;
    for (int z = 0; z < block_.depth; ++z) {
      for (int x = 0; x < block_.width; ++x) {
        if (kind_[cell(x, z)] != kCovered || seen_[cell(x, z)] != 0) continue;
        const std::vector<Place> cells = component(x, z);
        if (static_cast<int>(cells.size()) >= kCellsMin) out.push_back(describe(cells));
      }
    }
    return out;
  }

 private:
  using Place = std::pair<int, int>;
  enum Kind : std::uint8_t { kOpen, kCovered, kRock };

  std::size_t count() const { return static_cast<std::size_t>(block_.width) * static_cast<std::size_t>(block_.depth); }
  std::size_t cell(int x, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(block_.width) + static_cast<std::size_t>(x);
  }
  bool inside(int x, int z) const { return x >= 0 && z >= 0 && x < block_.width && z < block_.depth; }

  std::vector<Place> component(int x, int z) {
    std::vector<Place> cells{{x, z}};
    seen_[cell(x, z)] = 1;
    for (std::size_t n = 0; n < cells.size(); ++n) {
      for (const auto& [dx, dz] : kSides) {
        const int nx = cells[n].first + dx;
        const int nz = cells[n].second + dz;
        if (!inside(nx, nz) || seen_[cell(nx, nz)] != 0 || kind_[cell(nx, nz)] != kCovered) continue;
        seen_[cell(nx, nz)] = 1;
        cells.emplace_back(nx, nz);
      }
    }
    return cells;
  }

  Cavity describe(const std::vector<Place>& cells) const {
    Cavity out{cells[0].first, cells[0].second, static_cast<int>(cells.size()), 0, 0, 0};
    std::vector<Place> doors;
    double clear = 0;
    for (const auto& [x, z] : cells) {
      int up = y_;
      while (up < block_.height && block_.rock[block_.at(x, up, z)] == 0) ++up;
      int down = y_;
      while (down >= 0 && block_.rock[block_.at(x, down, z)] == 0) --down;
      clear += up - down - 1;
      const bool is_door = std::ranges::any_of(kSides, [&, px = x, pz = z](const auto& side) {
        const int nx = px + side.first;
        const int nz = pz + side.second;
        return inside(nx, nz) && kind_[cell(nx, nz)] == kOpen;
      });
      if (is_door) doors.emplace_back(x, z);
    }
    out.clearance = clear / static_cast<double>(cells.size());
    out.mouths = count_mouths(doors);
    out.depth = deepest(cells, doors);
    return out;
  }

  static int count_mouths(const std::vector<Place>& doors) {
    std::vector<std::uint8_t> seen(doors.size(), 0);
    int mouths = 0;
    for (std::size_t first = 0; first < doors.size(); ++first) {
      if (seen[first] != 0) continue;
      std::vector<std::size_t> linked{first};
      seen[first] = 1;
      for (std::size_t n = 0; n < linked.size(); ++n) {
        for (std::size_t other = 0; other < doors.size(); ++other) {
          if (seen[other] != 0 || std::abs(doors[other].first - doors[linked[n]].first) > kMouthLink ||
              std::abs(doors[other].second - doors[linked[n]].second) > kMouthLink)
            continue;
          seen[other] = 1;
          linked.push_back(other);
        }
      }
      mouths += static_cast<int>(linked.size()) >= kMouthMin ? 1 : 0;
    }
    return mouths;
  }

  static int deepest(const std::vector<Place>& cells, const std::vector<Place>& doors) {
    int out = 0;
    for (const auto& [x, z] : cells) {
      int nearest = doors.empty() ? 0 : 1 << 20;
      for (const auto& [dx, dz] : doors) nearest = std::min(nearest, (dx - x) * (dx - x) + (dz - z) * (dz - z));
      while ((out + 1) * (out + 1) <= nearest) ++out;
    }
    return out;
  }

  const RockBlock& block_;
  int y_;
  std::vector<std::uint8_t> kind_, seen_;
};

}  // namespace

std::vector<Cavity> find_cavities(const RockBlock& block, int y) {
  return Slice(block, y).cavities();
}

int count_overhangs(const RockBlock& block, int gap) {
  int out = 0;
  for (int z = 0; z < block.depth; ++z) {
    for (int x = 0; x < block.width; ++x) {
      int air = 0;
      bool over_rock = false;
      bool found = false;
      for (int y = 0; y < block.height && !found; ++y) {
        const bool is_rock = block.rock[block.at(x, y, z)] != 0;
        found = is_rock && over_rock && air >= gap;
        over_rock = over_rock || is_rock;
        air = is_rock ? 0 : air + 1;
      }
      out += found ? 1 : 0;
    }
  }
  return out;
}

std::vector<int> find_detached(const RockBlock& block) {
  struct Voxel {
    int x, y, z;
  };
  std::vector<std::uint8_t> seen(block.rock.size(), 0);
  std::vector<Voxel> stack;
  const auto visit = [&](int x, int y, int z) {
    if (x < 0 || y < 0 || z < 0 || x >= block.width || y >= block.height || z >= block.depth) return;
    const std::size_t at = block.at(x, y, z);
    if (block.rock[at] == 0 || seen[at] != 0) return;
    seen[at] = 1;
    stack.push_back({x, y, z});
  };
  const auto flood = [&] {
    int count = 0;
    while (!stack.empty()) {
      const Voxel v = stack.back();
      stack.pop_back();
      ++count;
      visit(v.x + 1, v.y, v.z);
      visit(v.x - 1, v.y, v.z);
      visit(v.x, v.y + 1, v.z);
      visit(v.x, v.y - 1, v.z);
      visit(v.x, v.y, v.z + 1);
      visit(v.x, v.y, v.z - 1);
    }
    return count;
  };
  for (int z = 0; z < block.depth; ++z) {
    for (int x = 0; x < block.width; ++x) {
      const bool is_side = x == 0 || z == 0 || x + 1 == block.width || z + 1 == block.depth;
      for (int y = 0; y < (is_side ? block.height : 1); ++y) visit(x, y, z);
    }
  }
  flood();
  std::vector<int> out;
  for (int y = 0; y < block.height; ++y) {
    for (int z = 0; z < block.depth; ++z) {
      for (int x = 0; x < block.width; ++x) {
        visit(x, y, z);
        if (!stack.empty()) out.push_back(flood());
      }
    }
  }
  std::ranges::sort(out, std::greater<>());
  return out;
}

namespace {

bool is_shore(const RockBlock& block, int x, int y, int z) {
  return block.rock[block.at(x, y, z)] != 0 && std::ranges::any_of(kSides, [&](const auto& side) {
           return block.rock[block.at(x + side.first, y, z + side.second)] == 0;
         });
}

bool rises(const RockBlock& block, int x, int y, int z, int reach) {
  return std::ranges::any_of(kSides, [&](const auto& side) {
    for (int n = 0; n <= reach; ++n) {
      const int nx = x + n * side.first;
      const int nz = z + n * side.second;
      if (nx < 0 || nz < 0 || nx >= block.width || nz >= block.depth) return false;
      if (block.rock[block.at(nx, y, nz)] != 0) return true;
    }
    return false;
  });
}

}  // namespace

int coast_cells(const RockBlock& block, int y) {
  int out = 0;
  for (int z = 1; z + 1 < block.depth; ++z) {
    for (int x = 1; x + 1 < block.width; ++x) out += is_shore(block, x, y, z) ? 1 : 0;
  }
  return out;
}

int cliff_cells(const RockBlock& block, int y, int rise, int reach) {
  int out = 0;
  for (int z = 1; z + 1 < block.depth; ++z) {
    for (int x = 1; x + 1 < block.width; ++x) {
      out += is_shore(block, x, y, z) && rises(block, x, y + rise, z, reach) ? 1 : 0;
    }
  }
  return out;
}

}  // namespace talus::cli
