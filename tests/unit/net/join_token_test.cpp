#include "server/net/join_token.hpp"

#include <gtest/gtest.h>
#include <jwt.h>

#include <cstdlib>
#include <fstream>
#include <memory>

namespace talus::server {
namespace {

constexpr std::int64_t kNow = 1'800'000'000;
const std::string kKey = "0123456789abcdef0123456789abcdef";

struct Claims {
  std::string world = "default";
  long ends = kNow + 60;
  long begins = 0;
  jwt_alg_t algorithm = JWT_ALG_HS256;
  std::string key = kKey;
};

std::string token_of(const Claims& claims) {
  jwt_t* raw = nullptr;
  jwt_new(&raw);
  const std::unique_ptr<jwt_t, decltype(&jwt_free)> token(raw, &jwt_free);
  if (!claims.world.empty()) jwt_add_grant(raw, "world", claims.world.c_str());
  if (claims.ends != 0) jwt_add_grant_int(raw, "exp", claims.ends);
  if (claims.begins != 0) jwt_add_grant_int(raw, "nbf", claims.begins);
  const bool is_signed = claims.algorithm != JWT_ALG_NONE;
  jwt_set_alg(raw, claims.algorithm, is_signed ? reinterpret_cast<const unsigned char*>(claims.key.data()) : nullptr,
              is_signed ? static_cast<int>(claims.key.size()) : 0);
  const std::unique_ptr<char, void (*)(void*)> text(jwt_encode_str(raw), &std::free);
  return text.get();
}

TokenKeys keys_of(std::initializer_list<std::string> keys) {
  std::vector<std::string> files;
  for (const std::string& key : keys) {
    files.push_back(testing::TempDir() + "join_token_test_" + std::to_string(files.size()));
    std::ofstream(files.back()) << key << "\n";
  }
  return *TokenKeys::load(files);
}

TEST(JoinToken, OpensItsWorldUntilItEnds) {
  const TokenKeys keys = keys_of({kKey});
  const std::string token = token_of({});
  EXPECT_EQ(keys.fault_of(token, "default", kNow), std::nullopt);
  EXPECT_EQ(keys.fault_of(token, "default", kNow + 59), std::nullopt);
  EXPECT_EQ(keys.fault_of(token, "default", kNow + 60), TokenFault::kExpired);
  EXPECT_EQ(keys.fault_of(token, "alps", kNow), TokenFault::kOtherWorld);
  EXPECT_EQ(keys.fault_of("", "default", kNow), TokenFault::kMissing);
  EXPECT_EQ(keys.fault_of(token_of({.begins = kNow + 10}), "default", kNow), TokenFault::kNotYet);
  EXPECT_EQ(keys.fault_of(token_of({.begins = kNow + 10}), "default", kNow + 10), std::nullopt);
}

TEST(JoinToken, WithoutAnEndOrAWorldOpensNothing) {
  const TokenKeys keys = keys_of({kKey});
  EXPECT_EQ(keys.fault_of(token_of({.ends = 0}), "default", kNow), TokenFault::kExpired);
  EXPECT_EQ(keys.fault_of(token_of({.world = ""}), "default", kNow), TokenFault::kOtherWorld);
}

TEST(JoinToken, WhoseTimesAreNoWholeNumbersIsBad) {
  const TokenKeys keys = keys_of({kKey});
  const auto fault_with = [&](const char* grants) {
    jwt_t* raw = nullptr;
    jwt_new(&raw);
    const std::unique_ptr<jwt_t, decltype(&jwt_free)> token(raw, &jwt_free);
    EXPECT_EQ(jwt_add_grants_json(raw, grants), 0);
    jwt_set_alg(raw, JWT_ALG_HS256, reinterpret_cast<const unsigned char*>(kKey.data()), static_cast<int>(kKey.size()));
    const std::unique_ptr<char, void (*)(void*)> text(jwt_encode_str(raw), &std::free);
    return keys.fault_of(text.get(), "default", kNow);
  };
  EXPECT_EQ(fault_with(R"({"world":"default","exp":1800000060,"nbf":1800000000})"), std::nullopt);
  EXPECT_EQ(fault_with(R"({"world":"default","exp":1800000060,"nbf":"1900000000"})"), TokenFault::kBad);
  EXPECT_EQ(fault_with(R"({"world":"default","exp":1800000060,"nbf":1900000000.5})"), TokenFault::kBad);
  EXPECT_EQ(fault_with(R"({"world":"default","exp":1800000060,"nbf":null})"), TokenFault::kBad);
  EXPECT_EQ(fault_with(R"({"world":"default","exp":1800000060,"nbf":[1]})"), TokenFault::kBad);
  EXPECT_EQ(fault_with(R"({"world":"default","exp":"1800000060"})"), TokenFault::kBad);
}

TEST(JoinToken, IsTakenFromOneAlgorithmOnly) {
  const TokenKeys keys = keys_of({kKey});
  for (const jwt_alg_t other : {JWT_ALG_NONE, JWT_ALG_HS384, JWT_ALG_HS512}) {
    EXPECT_EQ(keys.fault_of(token_of({.algorithm = other}), "default", kNow), TokenFault::kBad) << other;
  }
  // The header says none, the signature is gone: the oldest trick.
  const std::string good = token_of({});
  const std::string unsigned_head = "eyJhbGciOiJub25lIiwidHlwIjoiSldUIn0";  // {"alg":"none","typ":"JWT"}
  const std::string claims = good.substr(good.find('.'), good.rfind('.') - good.find('.') + 1);
  EXPECT_EQ(keys.fault_of(unsigned_head + claims, "default", kNow), TokenFault::kBad);
  EXPECT_EQ(keys.fault_of("eyJhbGciOiJSUzI1NiIsInR5cCI6IkpXVCJ9" + good.substr(good.find('.')), "default", kNow),
            TokenFault::kBad);
}

TEST(JoinToken, IsRefusedAtEveryPrefixAndWithAnyByteChanged) {
  const TokenKeys keys = keys_of({kKey});
  const std::string good = token_of({});
  for (std::size_t size = 1; size < good.size(); ++size) {
    EXPECT_EQ(keys.fault_of(good.substr(0, size), "default", kNow), TokenFault::kBad) << size;
  }
  for (std::size_t at = 0; at < good.size() - 1; ++at) {  // the last letter has bits that no byte of the signature has
    std::string changed = good;
    changed[at] = changed[at] == 'A' ? 'B' : 'A';
    EXPECT_NE(keys.fault_of(changed, "default", kNow), std::nullopt) << at;
  }
  for (const std::string& noise : {std::string("."), std::string(".."), std::string("a.b.c"), std::string(1024, 'A'),
                                   std::string(2000, '.'), std::string("a\0b", 3), std::string("{}.{}.{}")}) {
    EXPECT_EQ(keys.fault_of(noise, "default", kNow), TokenFault::kBad);
  }
}

TEST(JoinToken, AnyOfSeveralKeysOpensSoThatKeysCanBeChanged) {
  const std::string next = "another key, of thirty-two bytes!";
  const TokenKeys both = keys_of({kKey, next});
  EXPECT_EQ(both.fault_of(token_of({}), "default", kNow), std::nullopt);
  EXPECT_EQ(both.fault_of(token_of({.key = next}), "default", kNow), std::nullopt);
  EXPECT_EQ(keys_of({next}).fault_of(token_of({}), "default", kNow), TokenFault::kBad);
  EXPECT_EQ(TokenKeys{}.fault_of("", "default", kNow), std::nullopt) << "without keys everybody may read";
}

TEST(JoinToken, AKeyThatIsShortOrMissingIsRefusedByName) {
  const std::string file = testing::TempDir() + "join_token_short";
  std::ofstream(file) << "short\n";
  const std::vector<std::string> files{file};
  const auto loaded = TokenKeys::load(files);
  ASSERT_FALSE(loaded.has_value());
  EXPECT_NE(loaded.error().find(file), std::string::npos);
  const std::vector<std::string> none{"/no/such/key"};
  EXPECT_FALSE(TokenKeys::load(none).has_value());
}

}  // namespace
}  // namespace talus::server
