// Several clients on one queue, served one job at a time: no threads, no clock, every run the same.
#include "server/schedule/fair_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "tests/support/random.hpp"

namespace talus::server {
namespace {

struct Job : FairQueue::Item {
  ClientId owner = 0;
  char name = '?';
};

std::shared_ptr<Job> job(ClientId owner, double urgency = 0.0, double cost_s = 0.001, char name = '?') {
  auto out = std::make_shared<Job>();
  out->owner = owner;
  out->urgency = urgency;
  out->cost_s = cost_s;
  out->name = name;
  return out;
}

const Job& as_job(const FairQueue::ItemRef& item) {
  return static_cast<const Job&>(*item);
}

std::string order_of(FairQueue& queue) {
  std::string out;
  while (const auto item = queue.pop()) out += as_job(item).name;
  return out;
}

TEST(FairQueue, ServesOneClientItsMostUrgentFirstAndEqualsInOrderOfArrival) {
  FairQueue queue(256);
  const double urgencies[5]{3.0, 1.0, 2.0, 1.0, 1.0};
  for (int i = 0; i < 5; ++i) queue.push(job(1, urgencies[i], 0.001, static_cast<char>('a' + i)), 1, Lane::kView);
  EXPECT_EQ(order_of(queue), "bdeca");
  EXPECT_EQ(queue.cost_s(), 0.0);
}

TEST(FairQueue, LooksAtUrgencyWhenAJobIsTakenNotWhenItCame) {
  FairQueue queue(256);
  const auto first = job(1, 1.0, 0.001, 'a');
  queue.push(first, 1, Lane::kView);
  queue.push(job(1, 2.0, 0.001, 'b'), 1, Lane::kView);
  first->urgency = 50.0;
  EXPECT_EQ(order_of(queue), "ba");
}

TEST(FairQueue, ServesANewClientNextHoweverMuchAnotherHasAskedFor) {
  FairQueue queue(200'000);
  for (int i = 0; i < 100'000; ++i) queue.push(job(1, -1e9), 1, Lane::kView);
  for (int i = 0; i < 100; ++i) queue.pop();
  queue.push(job(2, 90.0), 2, Lane::kView);
  EXPECT_EQ(as_job(queue.pop()).owner, 2U);
}

TEST(FairQueue, SharesEquallyBetweenClientsThatAlwaysWantMore) {
  FairQueue queue(1000);
  std::map<ClientId, double> served_s;
  // A hundred at once, ten at once, one at a time; and jobs of unequal cost.
  const std::map<ClientId, int> depth{{1, 100}, {2, 10}, {3, 2}};
  const std::map<ClientId, double> cost_s{{1, 0.001}, {2, 0.003}, {3, 0.0005}};
  for (const auto& [client, count] : depth) {
    for (int i = 0; i < count; ++i) queue.push(job(client, 0.0, cost_s.at(client)), client, Lane::kView);
  }
  for (int i = 0; i < 20'000; ++i) {
    const ClientId owner = as_job(queue.pop()).owner;
    served_s[owner] += cost_s.at(owner);
    queue.push(job(owner, 0.0, cost_s.at(owner)), owner, Lane::kView);
  }
  EXPECT_NEAR(served_s[1] / served_s[2], 1.0, 0.01);
  EXPECT_NEAR(served_s[1] / served_s[3], 1.0, 0.01);
}

TEST(FairQueue, GivesNoCreditForHavingWaited) {
  FairQueue queue(10'000);
  for (int i = 0; i < 1000; ++i) {
    queue.push(job(1), 1, Lane::kView);
    queue.pop();
  }
  // The second comes late: from here on they share, it does not catch up.
  int first = 0;
  for (int i = 0; i < 200; ++i) queue.push(job(1), 1, Lane::kView), queue.push(job(2), 2, Lane::kView);
  for (int i = 0; i < 200; ++i) first += as_job(queue.pop()).owner == 1 ? 1 : 0;
  EXPECT_NEAR(first, 100, 2);
}

TEST(FairQueue, PutsFeetBeforeViewBeforeCoverOfOneClient) {
  FairQueue queue(256);
  queue.push(job(1, 0.0, 0.001, 'c'), 1, Lane::kCover);
  queue.push(job(1, 5.0, 0.001, 'v'), 1, Lane::kView);
  queue.push(job(1, 9.0, 0.001, 'f'), 1, Lane::kFeet);
  EXPECT_EQ(order_of(queue), "fvc");
}

TEST(FairQueue, PutsWhatOneStandsOnBeforeWhatAnotherLooksAt) {
  FairQueue queue(256);
  for (int i = 0; i < 50; ++i) queue.push(job(1, 0.0, 0.001, 'v'), 1, Lane::kView);
  for (int i = 0; i < 8; ++i) queue.push(job(2, 0.0, 0.001, 'f'), 2, Lane::kFeet);
  EXPECT_EQ(order_of(queue).substr(0, 8), "ffffffff");
}

TEST(FairQueue, LetsNobodyLiveOnTheLaneThatGoesFirst) {
  FairQueue queue(256);
  for (int i = 0; i < 100; ++i) {
    queue.push(job(1), 1, Lane::kFeet);
    queue.push(job(2), 2, Lane::kView);
  }
  int second = 0;
  for (int i = 0; i < 2000; ++i) {
    const ClientId owner = as_job(queue.pop()).owner;
    second += owner == 2 ? 1 : 0;
    queue.push(job(owner), owner, owner == 1 ? Lane::kFeet : Lane::kView);
  }
  EXPECT_NEAR(second, 1000, 30) << "it is lent 50 ms, which are 50 jobs, once";
}

TEST(FairQueue, LetsTheBackgroundGoOnButLast) {
  FairQueue queue(1000);
  queue.push(job(0, 0.0, 0.001, 'b'), 0, Lane::kBackground);
  for (int i = 0; i < 400; ++i) queue.push(job(1, 0.0, 0.001, 'v'), 1, Lane::kView);
  const std::size_t at = order_of(queue).find('b');
  EXPECT_GT(at, 200U);
  EXPECT_LT(at, 300U);
}

TEST(FairQueue, LetsNoJobStarveBehindMoreUrgentOnesOfItsClient) {
  FairQueue queue(256);
  queue.push(job(1, 20.0, 0.001, 'o'), 1, Lane::kView);
  int waited = 0;
  for (; waited < 1000; ++waited) {
    queue.push(job(1, 0.0, 0.001, 'n'), 1, Lane::kView);
    if (as_job(queue.pop()).name == 'o') break;
  }
  EXPECT_LT(waited, 200);
}

TEST(FairQueue, MakesRoomForTheModestByTakingFromTheGreedy) {
  FairQueue queue(10);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(queue.push(job(1, i), 1, Lane::kView).is_queued);
  EXPECT_FALSE(queue.push(job(1, -1.0), 1, Lane::kView).is_queued) << "it would only displace its own";
  std::size_t admitted = 0;
  for (int i = 0; i < 10; ++i) {
    const auto pushed = queue.push(job(2), 2, Lane::kView);
    if (!pushed.is_queued) break;
    ++admitted;
    EXPECT_EQ(as_job(pushed.displaced).owner, 1U);
    EXPECT_EQ(as_job(pushed.displaced).urgency, 10.0 - static_cast<double>(admitted)) << "the least urgent goes";
  }
  EXPECT_EQ(admitted, 5U) << "half of the lane each";
  EXPECT_EQ(queue.size(Lane::kView), 10U);
  EXPECT_TRUE(queue.push(job(1), 1, Lane::kCover).is_queued) << "lanes are full one by one";
}

TEST(FairQueue, ServesAJobThatTwoWantAtWhicheversTurnComesFirst) {
  FairQueue queue(1000);
  std::shared_ptr<Job> shared;
  for (int i = 0; i < 100; ++i) {
    auto one = job(1, i, 0.001, 'x');
    if (i == 99) shared = one, one->name = 's';
    queue.push(one, 1, Lane::kView);
  }
  queue.claim(shared, 2);
  const std::string order = order_of(queue);
  EXPECT_LT(order.find('s'), 2U);
  EXPECT_EQ(order.size(), 100U) << "it is served once";
  EXPECT_EQ(shared->client(), 2U);
}

TEST(FairQueue, KeepsAJobForTheOtherWhenOneWantsItNoMore) {
  FairQueue queue(10);
  const auto shared = job(1);
  queue.push(shared, 1, Lane::kView);
  queue.claim(shared, 2);
  queue.claim(shared, 2);
  queue.unclaim(shared, 1);
  EXPECT_EQ(queue.size(Lane::kView), 1U);
  EXPECT_EQ(queue.pop(), shared);
  EXPECT_EQ(shared->client(), 2U);
  EXPECT_FALSE(queue.remove(shared));
  queue.unclaim(shared, 2);
  queue.claim(shared, 3);
  queue.move(shared, Lane::kFeet);
  EXPECT_TRUE(queue.empty()) << "what has started is nobody's to queue again";
}

TEST(FairQueue, ChargesWhatAJobTurnedOutToCost) {
  FairQueue queue(1000);
  std::map<ClientId, int> served;
  for (int i = 0; i < 400; ++i) queue.push(job(1), 1, Lane::kView), queue.push(job(2), 2, Lane::kView);
  for (int i = 0; i < 400; ++i) {
    const ClientId owner = as_job(queue.pop()).owner;
    ++served[owner];
    if (owner == 1) queue.charge(1, 0.003);  // four times what was predicted
  }
  EXPECT_NEAR(served[2], 4 * served[1], 8);
}

TEST(FairQueue, RemembersNoMoreClientsThanItMust) {
  FairQueue queue(256);
  for (ClientId client = 1; client < 20'000; ++client) {
    queue.push(job(client), client, Lane::kView);
    queue.pop();
  }
  EXPECT_LE(queue.clients(), 1100U);
}

/// Any order of operations keeps the books: sizes, costs, each job out exactly once.
TEST(FairQueue, LosesAndDoublesNothing) {
  constexpr std::uint64_t kSeed = 4711;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  talus::test::Random random(kSeed);
  FairQueue queue(20);
  std::vector<std::shared_ptr<Job>> queued;
  const auto lane = [&] { return static_cast<Lane>(random.whole(0, 3)); };
  const auto out = [&](const FairQueue::ItemRef& item) {
    const auto found = std::ranges::find(queued, item);
    ASSERT_NE(found, queued.end());
    queued.erase(found);
  };
  for (int i = 0; i < 50'000; ++i) {
    const auto client = static_cast<ClientId>(random.whole(1, 9));
    const auto any = [&] { return queued[static_cast<std::size_t>(random.bits() % queued.size())]; };
    switch (queued.empty() ? 0 : random.whole(0, 5)) {
      case 0:
      case 1: {
        auto one = job(client, random.real(0, 100), random.real(0, 0.01));
        const auto pushed = queue.push(one, client, lane());
        if (pushed.displaced != nullptr) out(pushed.displaced);
        if (pushed.is_queued) queued.push_back(one);
        break;
      }
      case 2:
        out(queue.pop());
        break;
      case 3:
        queue.claim(any(), client);
        break;
      case 4:
        queue.move(any(), lane());
        break;
      default: {
        const auto one = any();
        ASSERT_TRUE(queue.remove(one));
        out(one);
      }
    }
    std::size_t sizes = 0;
    for (std::size_t l = 0; l < kLanes; ++l) sizes += queue.size(static_cast<Lane>(l));
    ASSERT_EQ(sizes, queued.size());
    ASSERT_EQ(queue.empty(), queued.empty());
  }
  EXPECT_EQ(queue.clear().size(), queued.size());
}

TEST(FairQueue, LetsNoClientHaveMoreWaitingThanItsShareInAllLanes) {
  FairQueue queue(256, 3);
  for (const Lane lane : {Lane::kFeet, Lane::kView, Lane::kCover}) EXPECT_TRUE(queue.push(job(1), 1, lane).is_queued);
  const auto fourth = queue.push(job(1), 1, Lane::kView);
  EXPECT_FALSE(fourth.is_queued);
  EXPECT_TRUE(fourth.is_over_share);
  EXPECT_EQ(fourth.displaced, nullptr);
  EXPECT_TRUE(queue.push(job(2), 2, Lane::kView).is_queued) << "others have their own";
  queue.pop();
  queue.pop();
  EXPECT_TRUE(queue.push(job(1), 1, Lane::kView).is_queued) << "what has started waits no more";
}

}  // namespace
}  // namespace talus::server
