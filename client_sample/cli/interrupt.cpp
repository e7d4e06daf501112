#include "client_sample/cli/interrupt.hpp"

#include <csignal>

namespace talus::cli {
namespace {

volatile std::sig_atomic_t interrupts = 0;

}  // namespace

void catch_interrupt() {
  interrupts = 0;
  std::signal(SIGINT, [](int) {
    interrupts = 1;
    std::signal(SIGINT, SIG_DFL);
  });
}

bool is_interrupted() {
  return interrupts != 0;
}

}  // namespace talus::cli
