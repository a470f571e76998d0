// SPDX-License-Identifier: Apache-2.0
#include "tests/system/storm_watch.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>

#include "ipc/ring/real_atomics.hpp"

namespace handcast::storm {
namespace {

constexpr std::int64_t kLate_ns = 50'000'000;

char state_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  std::getline(file, line);
  const auto name_end = line.rfind(") ");
  return name_end == std::string::npos || name_end + 2 >= line.size() ? '?' : line[name_end + 2];
}

std::uint64_t newest_of(const ipc::Segment& ring) {
  return ipc::sequence_of(
      ipc::RealAtomics::load(ipc::control_words_of(ring).head(), std::memory_order_acquire));
}

bool is_waiting(std::uint64_t turn) { return turn % 2 == 1; }

}  // namespace

bool Watch::sleeps_beside_something_new() const {
  return is_waiting(reader_.notes().turn) && reader_.notes().seen < newest_of(reader_.ring()) &&
         state_of(reader_.pid()) == 'S';
}

/// If two looks find the reader asleep in the same turn, it did not wake up in between: it would
/// have read the new message.
void Watch::look(std::int64_t now_ns) {
  const auto turn = reader_.notes().turn.load();
  const bool same = turn == turn_ && reader_.pid() == pid_;
  turn_ = turn;
  pid_ = reader_.pid();
  if (!sleeps_beside_something_new() || reader_.notes().turn != turn) {
    since_ns_ = 0;
  } else if (!same || since_ns_ == 0) {
    since_ns_ = now_ns;
    counted_ = false;
  } else {
    const auto slept_ns = now_ns - since_ns_;
    longest_ns_ = std::max(longest_ns_, slept_ns);
    if (slept_ns > kLate_ns && !std::exchange(counted_, true)) ++late_;
  }
}

}  // namespace handcast::storm
