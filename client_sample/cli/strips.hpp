// A picture in strips, on every processor. Owner of its threads; they end before it returns.
#pragma once

#include <functional>
#include <string>

namespace talus::cli {

/// Calls `work(strip, worker)` for every strip 0..strips - 1 with a progress bar called `label`. Each worker (from 0)
/// is one thread; calls run at the same time and touch nothing in common but what their worker owns.
void for_each_strip(const std::string& label, int strips, const std::function<void(int strip, int worker)>& work);

/// Workers that for_each_strip uses for any number of strips.
int strip_workers();

}  // namespace talus::cli
