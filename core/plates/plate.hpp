// One plate as the macro field needs it: its faults, in frames that both plates of a fault share. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "core/plates/fault.hpp"

namespace talus {

/// Samples of a fault's curves are at most this far apart, in metres, up to kCurveSamplesMax of them.
inline constexpr double kCurveStep_m = 128;
inline constexpr int kCurveSamplesMin = 32;
inline constexpr int kCurveSamplesMax = 512;
/// Samples kept before t = 0 and after t = 1, which a cubic looks at.
inline constexpr int kCurveBefore = 1;
inline constexpr int kCurveAfter = 2;
/// The displacement of a fault stays within this share of its kite's width. A cubic through samples leaves them by a
/// quarter at most, so the curve stays within 0.55 * 1.25 = 0.69 of the kite: inside, and plates tile the plane.
inline constexpr float kKiteShare = 0.55f;
inline constexpr float kCubicOvershoot = 1.25f;

/// A displacement, in metres towards the front plate, over t = 0..1 along a fault: samples at t = i / samples, from
/// i = -kCurveBefore to samples + kCurveAfter. Interpolated by the cubic of Catmull and Rom.
struct FaultCurve {
  int samples = 0;
  std::size_t full = 0;   ///< where its first sample lies in Plate::curves
  std::size_t broad = 0;  ///< the same of the curve's first octave alone
};

/// A fault as one of its plates holds it. All but `side`, `front_from_site` and `curve` is the same on both sides, bit
/// for bit: it is made from the sites in the order front, back, and from triples of sites in the order of their keys.
struct PlateFault {
  SiteKey front;
  SiteKey back;
  glm::i64vec2 front_from_site{};  ///< the front site seen from this plate's, in whole metres
  float side = 1;                  ///< +1 on the front plate, -1 on the back one

  // The frame: distances in metres from the front site.
  float start_x = 0, start_z = 0;    ///< the vertex at t = 0
  float along_x = 0, along_z = 0;    ///< unit vector from there to the vertex at t = 1
  float across_x = 0, across_z = 0;  ///< unit normal, towards the front site
  float length_m = 0;
  float foot_t = 0;  ///< t of the sites' foot on the line
  float half_m = 0;  ///< half the distance of the sites
  FaultCurve curve;
  float reach_m = 0;  ///< |displacement| stays below this

  FaultFeatures features;
  float start_crest_m = 0, end_crest_m = 0;  ///< common to the three faults that meet at a vertex
  float start_hilliness = 0, end_hilliness = 0;
  float front_m = 0, back_m = 0;  ///< mean heights of the plates
  float blend_m = 0;              ///< half width of the passage from plate to plate
  float weight = 0;               ///< of this fault among its plate's, by its length
};

struct Plate {
  PlateSeat seat;
  std::vector<PlateFault> faults;  ///< in order around the plate
  std::vector<float> curves;       ///< samples of all faults
};

/// Makes plates from sites. Memory in `out` is reused.
class PlateBuilder {
 public:
  PlateBuilder(const PlateControls& plates, const MacroControls& macro);

  const PlateSites& sites() const { return sites_; }
  const PlateControls& controls() const { return plates_; }
  const MacroControls& macro() const { return macro_; }
  /// Names the controls: plates of equal fingerprints are equal.
  std::uint64_t fingerprint() const { return fingerprint_; }

  void build(const SiteKey& key, Plate& out) const;

 private:
  PlateControls plates_;
  MacroControls macro_;
  PlateSites sites_;
  std::uint64_t fingerprint_;
};

}  // namespace talus
