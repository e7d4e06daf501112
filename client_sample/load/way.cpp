#include <cmath>

#include "client_sample/load/bot.hpp"

namespace talus::load {
namespace {

double length(const glm::dvec3& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

}  // namespace

glm::dvec3 Way::at(double seconds) const {
  const double whole = length(to - from);
  if (whole <= 0 || speed_m_s <= 0) return from;
  const double gone = std::fmod(seconds * speed_m_s, 2 * whole);
  return from + (to - from) * ((gone <= whole ? gone : 2 * whole - gone) / whole);
}

glm::dvec3 Way::velocity(double seconds) const {
  const double whole = length(to - from);
  if (whole <= 0 || speed_m_s <= 0) return {};
  const bool goes_back = std::fmod(seconds * speed_m_s, 2 * whole) > whole;
  return (to - from) * ((goes_back ? -speed_m_s : speed_m_s) / whole);
}

}  // namespace talus::load
