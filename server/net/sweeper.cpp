#include "server/net/sweeper.hpp"

#include "server/net/http_answer.hpp"

namespace talus::server {

namespace {

constexpr auto kSweepEvery = std::chrono::milliseconds(50);

}  // namespace

Swept::Swept(Sweeper& sweeper) : sweeper_(sweeper), place_(sweeper.members_.size()) {
  sweeper_.members_.push_back(this);
}

Swept::~Swept() {
  // The last member takes the place that becomes free. A walk goes from the end, so none is missed.
  Swept* last = sweeper_.members_.back();
  sweeper_.members_[place_] = last;
  last->place_ = place_;
  sweeper_.members_.pop_back();
}

Sweeper::Sweeper(asio::io_context& context, const Clock& clock) : clock_(clock), timer_(context.get_executor()) {
  now_ = clock_.now();
  renew_date();
}

template <typename Visit>
void Sweeper::each(Visit visit) {
  for (std::size_t i = members_.size(); i-- > 0;) {
    if (i < members_.size()) visit(*members_[i]);
  }
}

Awaitable<void> Sweeper::run() {
  while (!is_stopped_) {
    timer_.expires_after(kSweepEvery);
    co_await timer_.async_wait(kAwait);
    renew_date();
    now_ = clock_.now();
    each([this](Swept& member) { member.sweep(now_); });
  }
}

void Sweeper::drain() {
  each([](Swept& member) { member.drain(); });
}

void Sweeper::abort() {
  each([](Swept& member) { member.abort(); });
}

void Sweeper::renew_date() {
  if (const std::int64_t now = clock_.unix_seconds(); now != date_seconds_) {
    date_seconds_ = now;
    http_date_ = server::http_date(now);
  }
}

}  // namespace talus::server
