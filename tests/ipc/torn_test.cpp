// SPDX-License-Identifier: Apache-2.0
// Readers against a writer that overwrites their messages, on rings with the fewest slots. Threads
// with one mapping replace the processes, so ThreadSanitizer sees both sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

#include "ipc/base/clock.hpp"
#include "tests/ipc/small_ring.hpp"

namespace handcast::ipc {
namespace {

using samples::SmallRing;

constexpr std::size_t kHalf = SmallRing::kWords / 2 * sizeof(PayloadWord);
constexpr int kRows = SmallRing::kRows;

struct Tally {
  std::uint64_t taken = 0, torn = 0, backwards = 0, overwritten = 0;
};

void write_until(SmallRing& ring, const std::atomic<int>& readers_left) {
  WriterCore<RealAtomics> writer(ring.words());
  writer.attach();
  SmallRing::Payload payload;
  while (readers_left.load(std::memory_order_relaxed) > 0) {
    const int slot = writer.loan();
    ASSERT_NE(slot, kNoSlot);
    payload.fill(writer.next_sequence());
    const auto* from = reinterpret_cast<const std::byte*>(payload.data());
    copy_to_slot(ring.slot(slot), from, kHalf);
    if (writer.next_sequence() % 8 == 0) std::this_thread::yield();
    copy_to_slot(ring.slot(slot) + kHalf, from + kHalf, kHalf);
    writer.publish(slot);
  }
}

enum class Verb { next, latest, nearest };

Tally read_some(SmallRing& ring, int row, Verb verb) {
  ReaderCore<RealAtomics> reader(ring.words(), row, 0);
  reader.start();
  SmallRing::Payload payload;
  std::uint64_t copies = 0, last = 0;
  const auto copy = [&](int slot) {  // every third copy yields the processor half way
    auto* to = reinterpret_cast<std::byte*>(payload.data());
    copy_from_slot(to, ring.slot(slot), kHalf);
    if (++copies % 3 == 0) std::this_thread::yield();
    copy_from_slot(to + kHalf, ring.slot(slot) + kHalf, kHalf);
  };
  const auto first_word = [&](int slot) {
    return static_cast<std::int64_t>(
        load_relaxed(*reinterpret_cast<const PayloadWord*>(ring.slot(slot))));
  };
  Tally tally;
  while (tally.taken < 20000) {
    Taken taken;
    const auto outcome = verb == Verb::next ? reader.next(reader.copying(copy), taken)
                         : verb == Verb::latest
                             ? reader.latest(reader.copying(copy), taken)
                             : reader.nearest(static_cast<std::int64_t>(last) + 5, first_word,
                                              reader.copying(copy), taken);
    if (outcome == Outcome::nothing) reader.wait(now_ns() + 1'000'000);
    if (outcome != Outcome::taken) continue;
    ++tally.taken;
    const auto wrong = [&](PayloadWord word) { return word != taken.sequence; };
    if (std::any_of(payload.begin(), payload.end(), wrong)) ++tally.torn;
    if (verb != Verb::nearest && taken.sequence <= last) ++tally.backwards;
    last = taken.sequence;
    tally.overwritten = copies - tally.taken;
  }
  return tally;
}

class Torn : public ::testing::TestWithParam<std::pair<int, bool>> {};

TEST_P(Torn, NoReaderEverGetsAMessageThatWasOverwrittenWhileItWasCopied) {
  SmallRing ring(GetParam().first, GetParam().second);
  std::atomic<int> readers_left{kRows};
  std::array<Tally, kRows> tallies;
  {
    std::jthread writer([&] { write_until(ring, readers_left); });
    std::array<std::jthread, kRows> readers;
    for (int row = 0; row < kRows; ++row)
      readers[static_cast<std::size_t>(row)] = std::jthread([&, row] {
        tallies[static_cast<std::size_t>(row)] = read_some(ring, row, static_cast<Verb>(row));
        --readers_left;
      });
  }
  for (const auto& tally : tallies) {
    EXPECT_EQ(tally.torn, 0u) << "torn of " << tally.taken << " messages; " << tally.overwritten
                              << " torn ones were rejected";
    EXPECT_EQ(tally.backwards, 0u);
    EXPECT_GT(tally.overwritten, 0u) << "the test must overwrite messages during a copy";
  }
}

INSTANTIATE_TEST_SUITE_P(OnFewSlots, Torn,
                         ::testing::Values(std::pair{2, false}, std::pair{3, true}));

}  // namespace
}  // namespace handcast::ipc
