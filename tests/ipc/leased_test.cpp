// SPDX-License-Identifier: Apache-2.0
// Leases against a writer at full speed. The payload is plain memory on both sides, and threads
// with one mapping replace the processes, so ThreadSanitizer checks the protocol.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

#include "ipc/base/clock.hpp"
#include "tests/ipc/small_ring.hpp"

namespace handcast::ipc {
namespace {

using samples::SmallRing;

struct Tally {
  std::uint64_t taken = 0, torn = 0, backwards = 0, revoked = 0;
};

SmallRing::Payload& payload_of(SmallRing& ring, int slot) {
  return *reinterpret_cast<SmallRing::Payload*>(ring.slot(slot));
}

/// Writes until all readers have finished; returns the number of loans that failed.
std::uint64_t write_until(SmallRing& ring, const std::atomic<int>& readers_left) {
  WriterCore<RealAtomics> writer(ring.words());
  writer.attach();
  std::uint64_t dropped = 0;
  for (std::uint64_t i = 0; readers_left.load(std::memory_order_relaxed) > 0; ++i) {
    const int slot = writer.loan();
    if (slot == kNoSlot) {
      ++dropped;
      std::this_thread::yield();
      continue;
    }
    auto& payload = payload_of(ring, slot);
    std::fill_n(payload.begin(), payload.size() / 2, writer.next_sequence());
    if (i % 8 == 0) std::this_thread::yield();
    std::fill(payload.begin() + payload.size() / 2, payload.end(), writer.next_sequence());
    if (i % 5 == 0)
      writer.abandon(slot);
    else
      writer.publish(slot);
  }
  return dropped;
}

struct Hand {
  Lease lease;
  Taken taken;
};

/// Holds two messages at a time. When it has taken the next one, it reads the older one again and
/// releases it.
Tally read_some(SmallRing& ring, int row) {
  ReaderCore<RealAtomics> reader(ring.words(), row, 0);
  reader.start();
  Tally tally;
  std::array<Hand, 2> hands;
  const auto whole = [&](const Hand& hand) {
    const auto& payload = payload_of(ring, hand.lease.slot);
    return std::all_of(payload.begin(), payload.end(),
                       [&](auto word) { return word == hand.taken.sequence; });
  };
  while (tally.taken < 10000) {
    auto& hand = hands[tally.taken % 2];
    const auto& other = hands[(tally.taken + 1) % 2];
    hand.lease.index = reader.free_lease();
    if (hand.lease.index < 0) return tally;
    const auto take = reader.leasing(hand.lease);
    const auto outcome = row % 2 ? reader.next(take, hand.taken) : reader.latest(take, hand.taken);
    if (outcome == Outcome::nothing) reader.wait(now_ns() + 1'000'000);
    if (outcome != Outcome::taken) continue;
    ++tally.taken;
    if (tally.taken % 3 == 0) std::this_thread::yield();
    if (!whole(hand)) ++tally.torn;
    if (tally.taken == 1) continue;
    if (!whole(other)) ++tally.torn;
    if (hand.taken.sequence <= other.taken.sequence) ++tally.backwards;
    if (!reader.release(other.lease)) ++tally.revoked;
  }
  return tally;
}

struct Run {
  std::array<Tally, SmallRing::kRows> tallies;
  std::uint64_t dropped = 0;
};

Run run(int slots, bool keep_history) {
  SmallRing ring(slots, keep_history);
  std::atomic<int> readers_left{SmallRing::kRows};
  Run run;
  {
    std::jthread writer([&] { run.dropped = write_until(ring, readers_left); });
    std::array<std::jthread, SmallRing::kRows> readers;
    for (std::size_t row = 0; row < readers.size(); ++row)
      readers[row] = std::jthread([&, row] {
        run.tallies[row] = read_some(ring, static_cast<int>(row));
        --readers_left;
      });
  }
  return run;
}

void expect_sound(const Run& run) {
  for (const auto& tally : run.tallies) {
    EXPECT_EQ(tally.taken, 10000u);
    EXPECT_EQ(tally.torn, 0u);
    EXPECT_EQ(tally.backwards, 0u);
    EXPECT_EQ(tally.revoked, 0u);
  }
}

TEST(Leased, AMessageInHandIsNeverWrittenTo) {
  // With one slot more for each reader no loan would fail; with one slot less all may wait for
  // ever.
  constexpr int kSlots = SmallRing::kRows + 2;
  for (const bool keep_history : {false, true}) {
    const auto scarce = run(kSlots, keep_history);
    expect_sound(scarce);
    EXPECT_GT(scarce.dropped, 0u) << "the test must have loans that fail because of leases";
  }
}

TEST(Leased, WithTwoSlotsMoreThanLeasesNoLoanFails) {
  const auto ample = run(SmallRing::kRows * kLeasesPerRow + 2, false);
  expect_sound(ample);
  EXPECT_EQ(ample.dropped, 0u);
}

}  // namespace
}  // namespace handcast::ipc
