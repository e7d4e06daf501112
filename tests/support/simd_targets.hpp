// Runs a piece of a test once for every SIMD target that this build holds and this processor has.
#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <vector>

namespace talus::test {

/// Calls body(target name) with each target chosen in turn, then restores the best one. Returns how many there were.
template <class Body>
int for_each_simd_target(Body body) {
  int count = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    body(hwy::TargetName(target));
    ++count;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  return count;
}

}  // namespace talus::test
