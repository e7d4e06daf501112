// talusd: reads what it is asked, serves until a signal, ends cleanly.
#include <malloc.h>
#include <sys/resource.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <semaphore>
#include <string>
#include <variant>

#include "server/app/command_line.hpp"
#include "server/app/server.hpp"

namespace {

/// As many descriptors as the system lets us have: connections are bounded by a limit of our own.
void raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// Chunks are allocated by one thread and freed by another. With an arena for each thread that leaves every arena full
/// of holes; few arenas share them.
void tame_allocator() {
  constexpr int kArenas = 2;
  mallopt(M_ARENA_MAX, kArenas);
}

using talus::server::Serve;

/// The command line and its file once more, through the same checks as at the start; what is wrong changes nothing.
void reload(talus::server::Server& server, int argc, const char* const* argv) {
  const auto asked = talus::server::parse_command_line(argc, argv);
  if (const auto* serve = std::get_if<Serve>(&asked)) {
    server.reload(serve->settings);
  } else {
    server.refuse_reload(std::get<talus::server::PrintAndEnd>(asked).text);
  }
}

int serve(const talus::server::Settings& settings, int argc, const char* const* argv) {
  std::counting_semaphore<> signals{0};
  std::atomic<bool> is_stopping{false};
  const auto on_signal = [&](talus::server::Signal signal) {
    // Who asks twice does not want to wait for the drain.
    if (signal == talus::server::Signal::kStop && is_stopping.exchange(true)) std::_Exit(EXIT_FAILURE);
    signals.release();
  };
  auto server = talus::server::Server::start(settings, on_signal);
  if (!server) {
    std::fprintf(stderr, "talusd: %s", server.error().c_str());
    return EXIT_FAILURE;
  }
  std::printf("%s\n", (*server)->ready_line().c_str());
  std::fflush(stdout);
  for (signals.acquire(); !is_stopping; signals.acquire()) reload(**server, argc, argv);
  (*server)->stop();
  if ((*server)->has_hung_job()) {
    // It runs on in code that a normal end would take down under it.
    std::fflush(nullptr);
    std::_Exit(EXIT_SUCCESS);
  }
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  tame_allocator();
  raise_descriptor_limit();
  const auto asked = talus::server::parse_command_line(argc, argv);
  if (const auto* print = std::get_if<talus::server::PrintAndEnd>(&asked)) {
    std::fputs(print->text.c_str(), print->status == 0 ? stdout : stderr);
    return print->status;
  }
  return serve(std::get<Serve>(asked).settings, argc, argv);
}
