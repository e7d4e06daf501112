#include "client_sample/cli/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace talus::cli {
namespace {

constexpr std::size_t kBarColumns = 32;

}  // namespace

Progress::Progress(std::string label, std::size_t total)
    : label_(std::move(label)), total_(std::max<std::size_t>(total, 1)), is_shown_(isatty(STDERR_FILENO) == 1) {
  if (is_shown_) draw();
}

Progress::~Progress() {
  if (is_shown_) fmt::print(stderr, "\n");
}

void Progress::step() {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (is_shown_) draw();
}

void Progress::draw() {
  const std::size_t filled = std::min(kBarColumns, done_ * kBarColumns / total_);
  const double seconds = std::chrono::duration<double>(Clock::now() - began_).count();
  const double left = done_ == 0 ? 0.0 : seconds / static_cast<double>(done_) * static_cast<double>(total_ - done_);
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3}%  {:.0f} s, {:.0f} s left ", label_, "", filled, "",
             kBarColumns - filled, done_ * 100 / total_, seconds, left);
  std::fflush(stderr);
}

}  // namespace talus::cli
