#include "tests/bench/connections/served.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "tests/sim/peer.hpp"

extern char** environ;

namespace talus::bench {

namespace {

constexpr std::size_t kPageBytes = 4096;

std::string text_member(const std::string& json, const std::string& name) {
  const std::string mark = "\"" + name + "\":\"";
  const std::size_t at = json.find(mark);
  if (at == std::string::npos) return {};
  return json.substr(at + mark.size(), json.find('"', at + mark.size()) - at - mark.size());
}

/// Sum of the numbers behind "r", "w" and "f" in lines such as skmem:(r0,rb131072,t0,tb2626560,f0,w0,o0,bl0,d0).
std::size_t socket_memory(const std::string& line) {
  std::size_t sum = 0;
  const std::size_t at = line.find("skmem:(");
  if (at == std::string::npos) return 0;
  std::istringstream parts(line.substr(at + 7));
  for (std::string part; std::getline(parts, part, ',');) {
    const bool counts = part.size() > 1 && part[1] >= '0' && part[1] <= '9';
    if (counts && (part[0] == 'r' || part[0] == 'w' || part[0] == 'f')) sum += std::strtoull(&part[1], nullptr, 10);
  }
  return sum;
}

}  // namespace

Served::Served(const std::string& program, const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  std::vector<std::string> words{program,          "--listen",    "127.0.0.1:0", "--tcp-listen", "off",
                                 "--admin-listen", "127.0.0.1:0", "--log-level", "error"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> raw;
  for (std::string& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  const int fault = ::posix_spawn(&process_, program.c_str(), &actions, nullptr, raw.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  std::string line;
  for (char c = 0; fault == 0 && c != '\n' && ::read(ends[0], &c, 1) == 1;) line += c;
  ::close(ends[0]);
  http_ = text_member(line, "http");
  admin_ = text_member(line, "admin");
  if (http_.empty()) throw std::runtime_error(program + " did not get ready");
}

Served::~Served() {
  if (process_ <= 0) return;
  ::kill(process_, SIGTERM);
  ::waitpid(process_, nullptr, 0);
}

std::size_t Served::resident_bytes() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/statm");
  std::size_t all = 0;
  std::size_t resident = 0;
  file >> all >> resident;
  return resident * kPageBytes;
}

std::size_t Served::socket_bytes() const {
  const std::string command = "ss -tnmH 'sport = :" + http_.substr(http_.rfind(':') + 1) + "'";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  if (pipe == nullptr) throw std::runtime_error("ss cannot be run: install iproute2");
  std::size_t sum = 0;
  std::array<char, 4096> line;
  while (std::fgets(line.data(), line.size(), pipe.get()) != nullptr) sum += socket_memory(line.data());
  return sum;
}

double Served::metric(const std::string& name) const {
  const std::string body = server::get(admin_, "/metrics").body;
  const std::size_t at = body.find("\n" + name + " ");
  return at == std::string::npos ? 0 : std::atof(body.c_str() + at + name.size() + 2);
}

std::size_t machine_tcp_bytes() {
  std::ifstream file("/proc/net/sockstat");
  for (std::string line; std::getline(file, line);) {
    const std::size_t at = line.find(" mem ");
    if (line.rfind("TCP:", 0) == 0 && at != std::string::npos) {
      return std::strtoull(line.c_str() + at + 5, nullptr, 10) * kPageBytes;
    }
  }
  return 0;
}

}  // namespace talus::bench
