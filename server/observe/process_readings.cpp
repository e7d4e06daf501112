#include "server/observe/process_readings.hpp"

#include <dirent.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <memory>

namespace talus::server {

namespace {

double cpu_seconds() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double all = 0;
  double resident = 0;
  file >> all >> resident;  // in pages
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double open_descriptors() {
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir("/proc/self/fd"), ::closedir);
  if (folder == nullptr) return 0;
  int entries = 0;
  while (::readdir(folder.get()) != nullptr) ++entries;
  constexpr int kNotCounted = 3;  // this folder's own, and the two entries with dots
  return entries - kNotCounted;
}

double descriptors_max() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  return static_cast<double>(limit.rlim_cur);
}

}  // namespace

void watch_process(Metrics& metrics, std::int64_t started_unix_s) {
  metrics.watch({"process_cpu_seconds_total", "User and system time", {}, {}, true}, cpu_seconds);
  metrics.watch({"process_resident_memory_bytes", "Resident memory", {}, {}, false}, resident_bytes);
  metrics.watch({"process_open_fds", "Open file descriptors", {}, {}, false}, open_descriptors);
  metrics.watch({"process_max_fds", "File descriptors the process may open", {}, {}, false}, descriptors_max);
  metrics.watch({"process_start_time_seconds", "Start, seconds since 1970", {}, {}, false},
                [started_unix_s] { return static_cast<double>(started_unix_s); });
}

}  // namespace talus::server
