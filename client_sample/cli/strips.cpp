#include "client_sample/cli/strips.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "client_sample/cli/progress.hpp"

namespace talus::cli {

int strip_workers() {
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
}

void for_each_strip(const std::string& label, int strips, const std::function<void(int, int)>& work) {
  Progress progress(label, static_cast<std::size_t>(strips));
  std::atomic<int> next{0};
  const auto run = [&](int worker) {
    for (int strip = next.fetch_add(1); strip < strips; strip = next.fetch_add(1)) {
      work(strip, worker);
      progress.step();
    }
  };
  std::vector<std::jthread> threads;
  const int workers = std::min(strip_workers(), strips);
  for (int worker = 1; worker < workers; ++worker) threads.emplace_back(run, worker);
  run(0);
}

}  // namespace talus::cli
