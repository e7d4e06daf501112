// Boulders: flat domes scattered over the cells of a hashed lattice. Pure.
//
// Problem: noise has neither stones nor the bare ground between them. Answer: a lattice corner hashes to at most one
// dome, moved by less than half a cell and narrower than one, so that the four corners around a point hold all that can
// cover it; the highest wins. Based on: S. Worley, "A Cellular Texture Basis Function", 1996; what differs: domes
// instead of distances, and four cells are enough. Include inside a file that Highway compiles once per target.

#ifndef TALUS_BOULDER_ROW
#define TALUS_BOULDER_ROW
#include <array>
#include <cstdint>

#include "core/grid/axis.hpp"

namespace talus {

/// One size of boulders along one row.
struct BoulderRow {
  const Axis* x;  ///< two taps
  float fraction_z;
  std::array<std::uint32_t, 2> hash_z;
  float cells_per_m;
  float share;  ///< of the cells that hold one
};

}  // namespace talus
#endif  // TALUS_BOULDER_ROW

#if defined(TALUS_BOULDERS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_BOULDERS_INL
#undef TALUS_BOULDERS_INL
#else
#define TALUS_BOULDERS_INL
#endif

#include "core/base/jet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The highest dome over each lane, in cells: 0 between boulders, at most 0.3. A dome of radius r is 0.6 r high.
template <class D, class V = VecOf<D>>
HWY_INLINE Jet<V> boulders(D d, const BoulderRow& row, std::size_t i) {
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  const V one = hn::Set(d, 1.0f);
  const V tx = hn::LoadU(d, &row.x->fraction[i]);
  Jet<V> best{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (int tap = 0; tap < 4; ++tap) {
    const auto column = static_cast<std::size_t>(tap & 1);
    const auto line = static_cast<std::size_t>(tap >> 1);
    auto h = hn::Xor(hn::LoadU(du, &row.x->cell_hash[column][i]), hn::Set(du, row.hash_z[line]));
    // The 32-bit finaliser of MurmurHash3 (A. Appleby, 2011) without its last shift.
    h = hn::Xor(h, hn::ShiftRight<16>(h));
    h = hn::Mul(h, hn::Set(du, 0x85EBCA6BU));
    h = hn::Xor(h, hn::ShiftRight<13>(h));
    h = hn::Mul(h, hn::Set(du, 0xC2B2AE35U));
    // Four uniform bytes: whether, how wide, and where.
    const auto byte = [&](auto bits) { return hn::ConvertTo(d, hn::BitCast(di, hn::And(bits, hn::Set(du, 0xFFU)))); };
    const V chance = hn::Mul(byte(h), hn::Set(d, 1.0f / 256));
    const V radius = hn::Add(hn::Set(d, 0.2f), hn::Mul(byte(hn::ShiftRight<8>(h)), hn::Set(d, 0.3f / 255)));
    const V shift_x = hn::Mul(hn::Sub(byte(hn::ShiftRight<16>(h)), hn::Set(d, 127.5f)), hn::Set(d, 0.9f / 255));
    const V shift_z = hn::Mul(hn::Sub(byte(hn::ShiftRight<24>(h)), hn::Set(d, 127.5f)), hn::Set(d, 0.9f / 255));
    const V x = hn::Sub(hn::Sub(tx, hn::Set(d, static_cast<float>(column))), shift_x);
    const V z = hn::Sub(hn::Set(d, row.fraction_z - static_cast<float>(line)), shift_z);

    // 1 - q^2 with q = distance / radius, steep at the rim, capped by a flat top.
    const V inverse = hn::Div(one, hn::Mul(radius, radius));
    const V q2 = hn::Mul(hn::Add(hn::Mul(x, x), hn::Mul(z, z)), inverse);
    const V side = hn::Mul(hn::Sub(one, q2), hn::Set(d, 1.9f));
    const V height = hn::Mul(radius, hn::Set(d, 0.6f));
    const auto is_top = hn::Gt(side, one);
    const V value = hn::Mul(height, hn::Min(side, one));
    const V slope = hn::IfThenZeroElse(is_top, hn::Mul(hn::Mul(height, inverse), hn::Set(d, -3.8f)));
    const auto wins = hn::And(hn::Gt(value, best.v), hn::Lt(chance, hn::Set(d, row.share)));
    best = {hn::IfThenElse(wins, value, best.v), hn::IfThenElse(wins, hn::Mul(slope, x), best.x),
            hn::IfThenElse(wins, hn::Mul(slope, z), best.z)};
  }
  const V per_m = hn::Set(d, row.cells_per_m);
  return {best.v, hn::Mul(best.x, per_m), hn::Mul(best.z, per_m)};
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TALUS_BOULDERS_INL
