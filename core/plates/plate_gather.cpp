#include "core/plates/plate_gather.hpp"

#include <algorithm>

#include "core/grid/floor_div.hpp"
#include "core/plates/macro_nodes.hpp"

namespace talus {
namespace {

/// Regions are whole multiples of this, in metres, so that small boxes nearby share one.
constexpr std::int64_t kRegion_m = 2048;
/// Sites nearest to a region that other sites are held against: enough to turn nearly all away.
constexpr std::size_t kTestSites = 16;
/// Squares around a region that hold every plate with a share in it; see `fill`.
constexpr std::int64_t kShareSquares = 3;

double length2(const glm::i64vec2& v) {
  const auto x = static_cast<double>(v.x);
  const auto z = static_cast<double>(v.y);
  return x * x + z * z;
}

}  // namespace

const std::vector<Site>& PlateGather::near(const PlateBuilder& builder, const glm::i64vec2& low_m,
                                           const glm::i64vec2& high_m) {
  const bool inside = known_ && builder_ == builder.fingerprint() && low_m.x >= low_m_.x && low_m.y >= low_m_.y &&
                      high_m.x <= high_m_.x && high_m.y <= high_m_.y;
  if (inside) return sites_;
  const auto down = [](std::int64_t v) { return floor_div(v, kRegion_m) * kRegion_m; };
  low_m_ = {down(low_m.x), down(low_m.y)};
  high_m_ = {down(high_m.x) + kRegion_m, down(high_m.y) + kRegion_m};
  builder_ = builder.fingerprint();
  known_ = true;
  fill(builder);
  return sites_;
}

void PlateGather::add_sites(const PlateBuilder& builder, const glm::i64vec2& square) {
  if (squares_.empty()) squares_.resize(kSquaresEdge * kSquaresEdge);
  const auto low_bits = [](std::int64_t v) { return static_cast<std::uint64_t>(v) % kSquaresEdge; };
  Square& kept = squares_[low_bits(square.y) * kSquaresEdge + low_bits(square.x)];
  if (kept.count == 0 || kept.at != square || kept.builder != builder.fingerprint()) {
    const std::size_t before = around_.size();
    builder.sites().add_sites(square.x, square.y, around_);
    kept.at = square;
    kept.builder = builder.fingerprint();
    kept.count = around_.size() - before;
    std::copy_n(&around_[before], kept.count, kept.sites.begin());
    return;
  }
  around_.insert(around_.end(), kept.sites.begin(), kept.sites.begin() + static_cast<std::ptrdiff_t>(kept.count));
}

/// Which sites: let plate k have a share at p, r its site's distance to p, and let the way from the site to p leave k's
/// polygon after rho through the fault towards j, h being half the distance of the two sites. Distances to that fault
/// fall linearly along the way, from h at the site over 0 at rho, so p lies h (r / rho - 1) beyond it. A share there
/// needs h (r / rho - 1) <= kShareReach * blend + |displacement|, where blend <= blend_m * h / kFullWidth_m or blend =
/// blend_m with h >= kFullWidth_m, and |displacement| <= kKiteShare * kCubicOvershoot * h: so r / rho - 1 <= q with
/// q = kShareReach * blend_m / kFullWidth_m + kKiteShare * kCubicOvershoot.
/// For any site s the way crosses the line between k and s no earlier than rho, which in the same way gives: p lies at
/// most q |k - s| / 2 beyond that line, or |p - k|^2 - |p - s|^2 <= q |k - s|^2. The left side is linear in p, so over
/// a box its least value is at a corner.
/// How far: rho <= kSiteReach = 2.06 cells, so r <= 2.06 (1 + q) cells; with the manifest's blend_m <= 350, q <= 1.81,
/// and r <= 5.8 cells, less than 3 squares of 2 cells.
void PlateGather::fill(const PlateBuilder& builder) {
  const PlateSites& sites = builder.sites();
  around_.clear();
  const glm::i64vec2 first{sites.square_of(low_m_.x) - kShareSquares, sites.square_of(low_m_.y) - kShareSquares};
  const glm::i64vec2 last{sites.square_of(high_m_.x) + kShareSquares, sites.square_of(high_m_.y) + kShareSquares};
  for (std::int64_t z = first.y; z <= last.y; ++z) {
    for (std::int64_t x = first.x; x <= last.x; ++x) add_sites(builder, {x, z});
  }
  const glm::i64vec2 middle = (low_m_ + high_m_) / std::int64_t{2};
  const std::size_t tests = std::min(kTestSites, around_.size());
  std::ranges::partial_sort(
      around_, around_.begin() + static_cast<std::ptrdiff_t>(tests),
      [&](const Site& a, const Site& b) { return length2(a.at_m - middle) < length2(b.at_m - middle); });

  const double q = static_cast<double>(kShareReach) * builder.controls().blend_m / kFullWidth_m +
                   static_cast<double>(kKiteShare * kCubicOvershoot);
  const glm::dvec2 half = glm::dvec2(high_m_ - low_m_) * 0.5;
  sites_.clear();
  for (const Site& k : around_) {
    const glm::i64vec2 from_k = low_m_ - k.at_m;
    const auto is_beyond = [&](const Site& s) {
      const glm::i64vec2 apart = s.at_m - k.at_m;
      // At p = low + half + e, relative to k: |p|^2 - |p - apart|^2 = 2 p . apart - |apart|^2, least over |e| <= half.
      const double middle_x = static_cast<double>(from_k.x) + half.x;
      const double middle_z = static_cast<double>(from_k.y) + half.y;
      const auto x = static_cast<double>(apart.x);
      const auto z = static_cast<double>(apart.y);
      const double least = 2 * (middle_x * x + middle_z * z - half.x * std::abs(x) - half.y * std::abs(z));
      return least - length2(apart) > q * length2(apart) + 1;
    };
    if (std::none_of(around_.begin(), around_.begin() + static_cast<std::ptrdiff_t>(tests), is_beyond))
      sites_.push_back(k);
  }
  std::ranges::sort(sites_, {}, &Site::key);
}

}  // namespace talus
