// SPDX-License-Identifier: Apache-2.0
// Real processes that are killed at random moments.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <functional>
#include <random>

#include "ipc/ring/row_owner.hpp"
#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace std::chrono_literals;
using namespace handcast::ipc::samples;

/// A child process that runs `body` until kill(), or until the test ends.
class Child {
 public:
  explicit Child(const std::function<void()>& body) : pid_(::fork()) {
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    body();
    ::_exit(0);
  }
  ~Child() { kill(); }
  Child(Child&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}

  void kill() {
    if (pid_ > 0) ::kill(pid_, SIGKILL);
    join();
  }
  void join() {
    if (pid_ > 0) ::waitpid(std::exchange(pid_, -1), nullptr, 0);
  }

 private:
  pid_t pid_;
};

[[noreturn]] void publish_without_end(const Segment& segment) {
  auto writer = Writer<Page>::attach(again(segment));
  if (!writer) ::_exit(1);
  for (std::uint64_t i = 1;; ++i) {
    auto loan = writer->loan();
    loan->fill(i);
    if (i % 7 != 0) writer->publish(std::move(loan));  // otherwise it is abandoned
  }
}

struct Storm {
  std::uint64_t received = 0, torn = 0, backwards = 0, epochs = 0, died_writing = 0;
};

/// Reads the messages of writers that are killed one after the other, each after a random time.
Storm storm(int slots, bool keep_history, int kills) {
  const auto segment = make_ring<Page>(slots, keep_history);
  auto reader = must(Reader<Page>::attach(again(segment)));
  const auto words = control_words_of(segment);
  std::mt19937 random(11);
  Storm storm;
  std::uint64_t last_sequence = 0, last_epoch = 0;
  const auto read = [&](Deadline deadline) {
    const auto sample = random() % 2 ? reader.next(deadline) : reader.latest(deadline);
    if (!sample) return;
    ++storm.received;
    if (!(*sample)->whole()) ++storm.torn;
    if (sample->sequence() <= last_sequence || sample->epoch() < last_epoch) ++storm.backwards;
    if (sample->epoch() > last_epoch) ++storm.epochs;
    last_sequence = sample->sequence();
    last_epoch = sample->epoch();
  };
  const auto look_back = [&] {
    const auto sample = reader.at(0);
    if (sample && !(*sample)->whole()) ++storm.torn;
  };
  for (int i = 0; i < kills; ++i) {
    Child writer([&] { publish_without_end(segment); });
    look_back();
    read(Deadline::in(10s));  // messages of a new writer arrive, however the last one ended
    const auto end = Deadline::in(std::chrono::microseconds(random() % 3000));
    while (!end.passed()) read(end);
    writer.kill();
    look_back();
    for (int slot = 0; slot < slots; ++slot)
      if (RealAtomics::load(words.state(slot), std::memory_order_relaxed) & kWriting) {
        ++storm.died_writing;
        break;
      }
  }
  return storm;
}

class Crash : public ::testing::TestWithParam<std::pair<int, bool>> {};

TEST_P(Crash, AWriterKilledAtAnyMomentLeavesNoTornMessageAndItsSuccessorGoesOn) {
  constexpr int kKills = 250;
  const auto storm = ipc::storm(GetParam().first, GetParam().second, kKills);
  EXPECT_EQ(storm.torn, 0u);
  EXPECT_EQ(storm.backwards, 0u);
  EXPECT_GE(storm.received, static_cast<std::uint64_t>(kKills));
  EXPECT_GT(storm.epochs, static_cast<std::uint64_t>(kKills / 2))
      << "most writers must live long enough to publish";
  EXPECT_GT(storm.died_writing, 0u) << "the test must hit writers in the middle of a message";
}

INSTANTIATE_TEST_SUITE_P(OnFewSlots, Crash,
                         ::testing::Values(std::pair{2, false}, std::pair{3, true}));

TEST(Processes, ASleepingReaderIsWokenByAnotherProcess) {
  const auto segment = make_ring<Note>(4);
  const auto words = control_words_of(segment);
  Child child([&] {
    auto writer = Writer<Note>::attach(again(segment));
    while (!(RealAtomics::load(words.wait(0), std::memory_order_relaxed) & kWaiting)) ::usleep(100);
    ::usleep(20'000);  // until the reader sleeps
    writer->publish(note(1));
    ::pause();
  });
  ReaderCore<RealAtomics> reader(words, 0, 0);
  const auto give_up_ns = now_ns() + 20'000'000'000;  // limits a lost wake-up
  while (!reader.something_new() && now_ns() < give_up_ns) reader.wait(give_up_ns);
  EXPECT_TRUE(reader.something_new());
  EXPECT_LT(now_ns(), give_up_ns);
}

TEST(Processes, AReaderWaitsThroughTheDeathOfAWriter) {
  const auto segment = make_ring<Note>(4);
  auto reader = must(Reader<Note>::attach(again(segment)));
  {
    Child first([&] {
      auto writer = Writer<Note>::attach(again(segment));
      writer->publish(note(1));
      ::pause();
    });
    EXPECT_EQ(must(reader.next(Deadline::in(20s)))->value, 1u);
  }
  Child second([&] {
    ::usleep(30'000);
    auto writer = Writer<Note>::attach(again(segment));
    writer->publish(note(2));
    ::pause();
  });
  const auto sample = must(reader.next(Deadline::in(20s)));
  EXPECT_EQ(sample->value, 2u);
  EXPECT_EQ(sample.epoch(), 2u);
}

TEST(Processes, TheWriterLockOfAKilledProcessIsFree) {
  const auto segment = make_ring<Note>(4);
  auto reader = must(Reader<Note>::attach(again(segment)));
  Child child([&] {
    auto writer = Writer<Note>::attach(again(segment));
    writer->publish(note(1));
    ::pause();
  });
  ASSERT_TRUE(reader.next(Deadline::in(20s)));
  EXPECT_FALSE(Writer<Note>::attach(again(segment)));
  child.kill();
  EXPECT_TRUE(Writer<Note>::attach(again(segment)));
}

TEST(Processes, RowsOfDeadReadersAreTakenOver) {
  const auto segment = make_ring<Note>(4);
  const auto words = control_words_of(segment);
  auto keeps_its_row = must(Reader<Note>::attach(again(segment)));
  const auto kept = RealAtomics::load(words.owner(0), std::memory_order_relaxed);
  for (int i = 0; i < 3 * kReaderRows; ++i) {
    Child child([&] {
      auto reader = Reader<Note>::attach(again(segment));
      ::_exit(reader ? 0 : 1);  // without releasing the row
    });
    child.join();
  }
  std::vector<Reader<Note>> readers;
  for (int i = 0; i < kReaderRows - 1; ++i)
    readers.push_back(must(Reader<Note>::attach(again(segment))));
  EXPECT_FALSE(Reader<Note>::attach(again(segment)));
  EXPECT_EQ(RealAtomics::load(words.owner(0), std::memory_order_relaxed), kept);
}

/// A process with a reader that holds both leases and waits for more messages, until it is killed.
Child reader_with_hands_full(const Segment& segment) {
  const auto words = control_words_of(segment);
  auto child = Child([&] {
    auto reader = Reader<Page>::attach(again(segment), Wait::futex, Hold::lease);
    if (!reader) ::_exit(1);
    const auto first = reader->at(1), second = reader->at(2);
    [[maybe_unused]] const auto nothing = reader->next(Deadline::in(60s)),
                                still_nothing = reader->next(Deadline::in(60s));
  });
  const auto leased = [&](int row) {
    return is_leased(RealAtomics::load(words.lease(row, 0), std::memory_order_relaxed)) &&
           is_leased(RealAtomics::load(words.lease(row, 1), std::memory_order_relaxed));
  };
  const auto give_up = Deadline::in(20s);
  while (!leased(0) && !give_up.passed()) ::usleep(100);
  return child;
}

struct FullRing {
  FullRing() : segment(make_ring<Page>(3)), writer(must(Writer<Page>::attach(again(segment)))) {
    for (std::uint64_t i = 1; i <= 2; ++i) {
      auto loan = writer.loan();
      loan->fill(i);
      writer.publish(std::move(loan));
    }
  }
  Segment segment;
  Writer<Page> writer;
};

bool row_is_clean(const Segment& segment, int row) {
  const auto words = control_words_of(segment);
  const auto idle =
      free_word(generation_of(RealAtomics::load(words.owner(row), std::memory_order_seq_cst)));
  for (const auto* word :
       {&words.owner(row), &words.wait(row), &words.lease(row, 0), &words.lease(row, 1)})
    if (RealAtomics::load(*word, std::memory_order_seq_cst) != idle) return false;
  return true;
}

TEST(Processes, ASweepFreesTheRowsOfDeadReadersAndNoOthers) {
  FullRing ring;
  auto child = reader_with_hands_full(ring.segment);
  auto living = must(Reader<Page>::attach(again(ring.segment), Wait::futex, Hold::lease));
  const auto sample = must(living.latest(kNow));
  EXPECT_EQ(sweep_dead_rows(ring.segment), 0);
  child.kill();
  EXPECT_FALSE(row_is_clean(ring.segment, 0));
  EXPECT_EQ(sweep_dead_rows(ring.segment), 1);
  EXPECT_TRUE(row_is_clean(ring.segment, 0));
  EXPECT_EQ(sweep_dead_rows(ring.segment), 0);
  EXPECT_TRUE(is_leased(
      RealAtomics::load(control_words_of(ring.segment).lease(1, 0), std::memory_order_seq_cst)));
  EXPECT_TRUE(sample->whole());
}

TEST(Processes, ASweepMakesGoodASweeperThatDiedHalfWay) {
  const auto segment = make_ring<Note>(3);
  const auto words = control_words_of(segment);
  // Freed by a process that died before it cleared the other words.
  RealAtomics::store(words.owner(4), free_word(8), std::memory_order_seq_cst);
  RealAtomics::store(words.wait(4), free_word(7) | kWaiting, std::memory_order_seq_cst);
  RealAtomics::store(words.lease(4, 0), lease_word(7, 1, 1), std::memory_order_seq_cst);
  RealAtomics::store(words.lease(4, 1), free_word(7), std::memory_order_seq_cst);
  EXPECT_EQ(sweep_dead_rows(segment), 1);
  EXPECT_TRUE(row_is_clean(segment, 4));
  EXPECT_EQ(sweep_dead_rows(segment), 0);
}

TEST(Processes, AWriterWithoutAFreeSlotFreesThoseOfDeadReadersItself) {
  FullRing ring;  // three slots: one leased, the newest leased, one on loan
  auto child = reader_with_hands_full(ring.segment);
  const auto last = ring.writer.loan();
  ASSERT_TRUE(last);
  EXPECT_FALSE(ring.writer.loan());
  EXPECT_EQ(ring.writer.dropped(), 1u);
  child.kill();
  const auto give_up = Deadline::in(20s);
  // It sweeps at most every 100 ms.
  while (!ring.writer.loan() && !give_up.passed()) ::usleep(1000);
  EXPECT_FALSE(give_up.passed());
  EXPECT_TRUE(row_is_clean(ring.segment, 0));
}

TEST(Processes, AReaderThatComesTakesTheRowOfADeadOneWithoutWhatItLeft) {
  FullRing ring;
  auto child = reader_with_hands_full(ring.segment);
  child.kill();
  auto reader = must(Reader<Page>::attach(again(ring.segment), Wait::futex, Hold::lease));
  const auto words = control_words_of(ring.segment);
  EXPECT_EQ(generation_of(RealAtomics::load(words.owner(0), std::memory_order_seq_cst)), 2u);
  for (const auto* word : {&words.wait(0), &words.lease(0, 0), &words.lease(0, 1)})
    EXPECT_EQ(RealAtomics::load(*word, std::memory_order_seq_cst), free_word(2));
  const auto first = must(reader.at(1)), second = must(reader.at(2));
  EXPECT_TRUE(first.leased() && second.leased() && first->whole() && second->whole());
}

}  // namespace
}  // namespace handcast::ipc
