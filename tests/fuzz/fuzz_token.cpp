#include "core/base/check.hpp"
#include "server/net/join_token.hpp"
#include "tests/fuzz/fuzz_one.hpp"

#include <array>
#include <filesystem>
#include <fstream>

// A stranger's token. Nobody here has the key, so nothing may open.
int fuzz_one(const std::uint8_t* data, std::size_t size) {
  using namespace talus::server;
  static const TokenKeys keys = [] {
    const std::array<std::string, 1> files{(std::filesystem::temp_directory_path() / "talus_fuzz_token_key").string()};
    std::ofstream(files[0]) << "this key is nowhere in the corpus of tokens\n";
    return *TokenKeys::load(files);
  }();
  const auto fault = keys.fault_of({reinterpret_cast<const char*>(data), size}, "default", 1'800'000'000);
  TALUS_CHECK(fault == (size == 0 ? TokenFault::kMissing : TokenFault::kBad));
  return 0;
}
