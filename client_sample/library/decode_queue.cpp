#include "client_sample/library/decode_queue.hpp"

#include <algorithm>
#include <utility>

#include "protocol/meshopt_codec.hpp"

namespace talus::client {

void DecodeQueue::decode(Work& work) {
  auto mesh = protocol::decode_surface(work.bytes, work.lattice);
  if (mesh) {
    work.mesh = std::move(*mesh);
  } else {
    work.fault = mesh.error();
  }
  work.bytes = {};
}

DecodeQueue::WorkRef DecodeQueue::push(std::span<const std::byte> payload, const protocol::MeshLattice& lattice) {
  auto work = std::make_shared<Work>();
  work->lattice = lattice;
  if (payload.empty()) return work;
  work->bytes.assign(payload.begin(), payload.end());
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(work);
  }
  came_.notify_one();
  return work;
}

bool DecodeQueue::is_done(const WorkRef& work, bool decodes_here) {
  {
    const std::lock_guard lock(mutex_);
    if (std::ranges::find(begun_, work) != begun_.end()) return false;
    const auto found = std::ranges::find(waiting_, work);
    if (found == waiting_.end()) return true;
    if (!decodes_here) return false;
    waiting_.erase(found);
  }
  decode(*work);
  return true;
}

bool DecodeQueue::decode_one(std::chrono::milliseconds patience) {
  WorkRef work;
  {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, patience, [this] { return is_stopped_ || !waiting_.empty(); });
    if (is_stopped_ || waiting_.empty()) return false;
    work = std::move(waiting_.front());
    waiting_.pop_front();
    begun_.push_back(work);
  }
  decode(*work);
  finish(work);
  return true;
}

void DecodeQueue::finish(const WorkRef& work) {
  const std::lock_guard lock(mutex_);
  std::erase(begun_, work);
}

void DecodeQueue::clear() {
  std::deque<WorkRef> dropped;  // destroyed outside the lock
  const std::lock_guard lock(mutex_);
  dropped.swap(waiting_);
}

void DecodeQueue::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }
  came_.notify_all();
}

}  // namespace talus::client
