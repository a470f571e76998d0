// SPDX-License-Identifier: Apache-2.0
// SIGKILL before each step of a writer and of a reader, on real shared memory. The k-th process is
// killed before step k, until one reaches its end. After each, a successor must be able to use the
// ring.
#include <signal.h>
#include <sys/wait.h>

#include <functional>
#include <string>

#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace handcast::ipc::samples;

constexpr int kPayloadWords = 4;
constexpr int kLeaserRow = 1, kSleeperRow = 2, kVictimRow = 0;

/// RealAtomics, with SIGKILL before a chosen step. Steps are counted only in the child that will be
/// killed.
struct KillingAtomics {
  using Word = RealAtomics::Word;
  static inline int steps_left = -1;

  static void step() {
    if (steps_left >= 0 && steps_left-- == 0) ::raise(SIGKILL);
  }
  static std::uint64_t load(const Word& word, std::memory_order order) {
    return step(), RealAtomics::load(word, order);
  }
  static void store(Word& word, std::uint64_t value, std::memory_order order) {
    step(), RealAtomics::store(word, value, order);
  }
  static bool compare_exchange(Word& word, std::uint64_t expected, std::uint64_t desired,
                               std::memory_order order) {
    return step(), RealAtomics::compare_exchange(word, expected, desired, order);
  }
  static void fence(std::memory_order order) { step(), RealAtomics::fence(order); }
  static void wait(Word& word, std::uint64_t seen, std::int64_t until_ns) {
    step(), RealAtomics::wait(word, seen, until_ns);
  }
  static void wake(Word& word) { step(), RealAtomics::wake(word); }
};

/// A ring whose words can be accessed through both kinds of atomics.
class Ring {
 public:
  Ring(int slots, bool keep_history)
      : segment_(make_ring<Note>(slots, keep_history, sizeof(Note) + 64)) {}

  template <class Atomics>
  ControlWords<Atomics> words() const {
    auto* lines =
        reinterpret_cast<typename ControlWords<Atomics>::Line*>(segment_.data() + kControlOffset);
    return {lines, segment_.slots(), segment_.keep_history()};
  }
  std::uint64_t* payload(int slot) const {
    return reinterpret_cast<std::uint64_t*>(segment_.slot_at(slot));
  }

  bool is_whole(int slot, std::uint64_t sequence) const {
    for (int i = 0; i < kPayloadWords; ++i)
      if (__atomic_load_n(payload(slot) + i, __ATOMIC_RELAXED) !=
          sequence * 1000 + static_cast<std::uint64_t>(i))
        return false;
    return true;
  }
  /// True if each slot that claims to hold a message holds a whole one.
  bool all_whole() const {
    const auto words = this->words<RealAtomics>();
    for (int slot = 0; slot < words.slots(); ++slot) {
      const auto state = RealAtomics::load(words.state(slot), std::memory_order_acquire);
      if (holds_message(state) && !is_whole(slot, sequence_of(state))) return false;
    }
    return true;
  }

 private:
  Segment segment_;
};

/// Publishes or abandons one message. Returns false if there was no free slot.
template <class Atomics>
bool write_one(const Ring& ring, WriterCore<Atomics>& writer, bool abandons = false) {
  const int slot = writer.loan();
  if (slot == kNoSlot) return false;
  for (int i = 0; i < kPayloadWords; ++i) {
    KillingAtomics::step();
    __atomic_store_n(ring.payload(slot) + i,
                     writer.next_sequence() * 1000 + static_cast<std::uint64_t>(i),
                     __ATOMIC_RELAXED);
  }
  abandons ? writer.abandon(slot) : writer.publish(slot);
  return true;
}

/// Runs `life` in a child that is killed before step `k`. Returns false if it reached its end.
bool dies_before_step(int k, const std::function<void()>& life) {
  const auto child = ::fork();
  if (child == 0) {
    KillingAtomics::steps_left = k;
    life();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status)) {
    EXPECT_EQ(WEXITSTATUS(status), 0) << "a check inside the child failed";
  }
  return WIFSIGNALED(status);
}

std::uint64_t owner_of_this_process(std::uint64_t generation) {
  return owner_word(generation, 0, static_cast<std::uint64_t>(::getpid()));
}

ReaderCore<RealAtomics> reader_in(const Ring& ring, int row) {
  const auto words = ring.words<RealAtomics>();
  const auto before = RealAtomics::load(words.owner(row), std::memory_order_acquire);
  const auto after = owner_of_this_process(generation_of(before) + 1);
  EXPECT_TRUE(claim_row(words, row, before, after));
  return {words, row, generation_of(after)};
}

/// Starts a process that sleeps until it sees `sequence`. Its exit code is 0 if no wake-up was
/// lost.
pid_t start_sleeper(const Ring& ring, std::uint64_t sequence) {
  const auto child = ::fork();
  if (child != 0) return child;
  auto reader = reader_in(ring, kSleeperRow);
  const auto give_up_ns = now_ns() + 20'000'000'000;
  while (now_ns() < give_up_ns) {
    reader.catch_up();
    if (reader.seen() >= sequence) ::_exit(0);
    reader.wait(give_up_ns);
  }
  ::_exit(1);
}

void writers_life(const Ring& ring) {
  WriterCore<KillingAtomics> writer(ring.words<KillingAtomics>());
  writer.attach();
  for (int i = 0; i < 5; ++i) write_one(ring, writer, i == 2);
}

/// Checks the ring after a writer was killed at any step.
void expect_successor_goes_on(const Ring& ring) {
  auto reader = reader_in(ring, kVictimRow);
  Taken taken;
  int slot = kNoSlot;
  const auto copy = [&](int from) { slot = from; };
  EXPECT_EQ(reader.latest(reader.copying(copy), taken), Outcome::taken)
      << "there must always be a message";
  EXPECT_TRUE(ring.is_whole(slot, taken.sequence));
  EXPECT_TRUE(ring.all_whole());

  WriterCore<RealAtomics> successor(ring.words<RealAtomics>());
  successor.attach();
  EXPECT_TRUE(ring.all_whole());
  EXPECT_GT(successor.next_sequence(), taken.sequence);
  for (int i = 0; i < 6; ++i) {
    const auto next = successor.next_sequence();
    EXPECT_TRUE(write_one(ring, successor)) << "no slot may be lost";
    EXPECT_EQ(reader.latest(reader.copying(copy), taken), Outcome::taken);
    EXPECT_EQ(taken.sequence, next);
    EXPECT_TRUE(ring.all_whole());
  }
}

void kill_writer_at_every_step(bool with_lease) {
  int steps = 0;
  for (bool died = true; died; ++steps) {
    SCOPED_TRACE("before step " + std::to_string(steps));
    const Ring ring(4, false);
    WriterCore<RealAtomics> first(ring.words<RealAtomics>());
    first.attach();
    ASSERT_TRUE(write_one(ring, first));
    auto reader = reader_in(ring, kLeaserRow);
    Lease lease;
    Taken leased;
    if (with_lease) {
      ASSERT_EQ(reader.latest(reader.leasing(lease), leased), Outcome::taken);
    }
    const auto sleeper = start_sleeper(ring, 2);

    died = dies_before_step(steps, [&] { writers_life(ring); });
    expect_successor_goes_on(ring);

    if (with_lease) {
      EXPECT_TRUE(ring.is_whole(lease.slot, leased.sequence)) << "a leased message was written";
      EXPECT_TRUE(reader.release(lease));
    }
    int status = 0;
    ::waitpid(sleeper, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "a sleeping reader was not woken";
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(steps, 100) << "the writer must reach its end";
}

TEST(StepKill, AWriterMayDieBeforeAnyStep) { kill_writer_at_every_step(false); }
TEST(StepKill, AWriterMayDieBeforeAnyStepWhileAMessageIsLeased) { kill_writer_at_every_step(true); }

/// Claims the row of a dead reader, takes two leases, releases them, waits, copies, and releases
/// the row.
void readers_life(const Ring& ring, std::uint64_t before) {
  const auto words = ring.words<KillingAtomics>();
  const auto owner = owner_of_this_process(generation_of(before) + 1);
  if (!claim_row(words, kVictimRow, before, owner)) ::_exit(2);
  ReaderCore<KillingAtomics> reader(words, kVictimRow, generation_of(owner));
  reader.start();
  Lease leases[2];
  Taken taken;
  for (auto& lease : leases) {
    lease.index = reader.free_lease();
    if (lease.index < 0 || reader.next(reader.leasing(lease), taken) != Outcome::taken) ::_exit(3);
    if (!ring.is_whole(lease.slot, taken.sequence)) ::_exit(4);
  }
  for (auto& lease : leases)
    if (!reader.release(lease)) ::_exit(5);
  reader.catch_up();
  reader.wait(now_ns() + 1'000'000);
  const auto copy = [](int) {};
  if (reader.next(reader.copying(copy), taken) != Outcome::nothing) ::_exit(6);
  release_row(words, kVictimRow, owner);
}

TEST(StepKill, AReaderMayDieBeforeAnyStep) {
  int steps = 0, leases_left = 0, flags_left = 0;
  for (bool died = true; died; ++steps) {
    SCOPED_TRACE("before step " + std::to_string(steps));
    const Ring ring(6, true);
    const auto words = ring.words<RealAtomics>();
    WriterCore<RealAtomics> writer(words);
    writer.attach();
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(write_one(ring, writer));
    // The row belongs to a reader that died with all that it can leave behind: two leases and a
    // flag.
    const auto dead = owner_word(7, 0, 0);
    RealAtomics::store(words.owner(kVictimRow), dead, std::memory_order_relaxed);
    RealAtomics::store(words.wait(kVictimRow), free_word(7) | kWaiting, std::memory_order_relaxed);
    for (int index = 0; index < kLeasesPerRow; ++index)
      RealAtomics::store(words.lease(kVictimRow, index), lease_word(7, index, 1),
                         std::memory_order_relaxed);

    died = dies_before_step(steps, [&] { readers_life(ring, dead); });

    for (int index = 0; index < kLeasesPerRow; ++index)
      leases_left +=
          is_leased(RealAtomics::load(words.lease(kVictimRow, index), std::memory_order_relaxed));
    flags_left +=
        (RealAtomics::load(words.wait(kVictimRow), std::memory_order_relaxed) & kWaiting) != 0;
    for (int i = 0; i < 9; ++i)
      EXPECT_TRUE(write_one(ring, writer)) << "a dead reader must not stop the writer";

    const auto old = RealAtomics::load(words.owner(kVictimRow), std::memory_order_relaxed);
    const auto old_lease = RealAtomics::load(words.lease(kVictimRow, 0), std::memory_order_relaxed);
    auto next = reader_in(ring, kVictimRow);
    EXPECT_EQ(next.free_lease(), 0) << "a lease is leaked";
    EXPECT_FALSE(RealAtomics::load(words.wait(kVictimRow), std::memory_order_relaxed) & kWaiting);
    Lease lease;
    Taken taken;
    EXPECT_EQ(next.latest(next.leasing(lease), taken), Outcome::taken);
    EXPECT_TRUE(ring.is_whole(lease.slot, taken.sequence));
    const ReaderCore<RealAtomics> ghost(words, kVictimRow, generation_of(old));
    EXPECT_FALSE(ghost.release({0, 0, old_lease}))
        << "a reader that lost its row must not change it";
    EXPECT_TRUE(next.release(lease));
    if (HasFailure()) return;
  }
  EXPECT_GT(steps, 35) << "the reader must reach its end";
  EXPECT_GT(leases_left, 10) << "the test must hit readers that hold leases";
  EXPECT_GT(flags_left, 1) << "the test must hit readers that wait";
}

}  // namespace
}  // namespace handcast::ipc
