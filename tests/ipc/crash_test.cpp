// Real processes that die at any moment.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <functional>
#include <random>

#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace std::chrono_literals;
using namespace handcast::ipc::testing;

/// A child that runs `body` and dies with the test or by kill().
class Child {
 public:
  explicit Child(const std::function<void()>& body) : pid_(::fork()) {
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    body();
    ::_exit(0);
  }
  ~Child() { kill(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

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
    if (i % 7 != 0) writer->publish(std::move(loan));  // else abandoned
  }
}

struct Storm {
  std::uint64_t received = 0, torn = 0, backwards = 0, epochs = 0, died_writing = 0;
};

/// Reads what writers publish that are killed one after the other, each after a random time.
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
    read(Deadline::in(10s));  // a new writer is heard of, however the last one ended
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
  EXPECT_GT(storm.epochs, static_cast<std::uint64_t>(kKills / 2)) << "most writers lived long enough to be read";
  EXPECT_GT(storm.died_writing, 0u) << "the test must hit writers in the middle of a message";
}

INSTANTIATE_TEST_SUITE_P(OnFewSlots, Crash, ::testing::Values(std::pair{2, false}, std::pair{3, true}));

TEST(Processes, ASleepingReaderIsWokenByAnotherProcess) {
  const auto segment = make_ring<Note>(4);
  const auto words = control_words_of(segment);
  Child child([&] {
    auto writer = Writer<Note>::attach(again(segment));
    while (!(RealAtomics::load(words.wait(0), std::memory_order_relaxed) & kWaiting)) ::usleep(100);
    ::usleep(20'000);  // by now it sleeps
    writer->publish(note(1));
    ::pause();
  });
  ReaderCore<RealAtomics> reader(words, 0, 0);
  const auto give_up_ns = now_ns() + 20'000'000'000;  // a lost wake-up would end here
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
      ::_exit(reader ? 0 : 1);  // without giving the row back
    });
    child.join();
  }
  std::vector<Reader<Note>> readers;
  for (int i = 0; i < kReaderRows - 1; ++i) readers.push_back(must(Reader<Note>::attach(again(segment))));
  EXPECT_FALSE(Reader<Note>::attach(again(segment)));
  EXPECT_EQ(RealAtomics::load(words.owner(0), std::memory_order_relaxed), kept);
}

TEST(Processes, WhatADeadReaderLeftInItsRowIsCleared) {
  const auto segment = make_ring<Note>(2);
  const auto words = control_words_of(segment);
  Child child([&] {
    auto reader = Reader<Note>::attach(again(segment));
    RealAtomics::store(words.lease(0, 0), lease_word(1, 0, 1), std::memory_order_seq_cst);
    RealAtomics::store(words.lease(0, 1), lease_word(1, 1, 1), std::memory_order_seq_cst);
    RealAtomics::store(words.wait(0), free_word(1) | kWaiting, std::memory_order_seq_cst);
    ::_exit(0);
  });
  child.join();
  auto writer = must(Writer<Note>::attach(again(segment)));
  EXPECT_FALSE(writer.loan());
  auto reader = must(Reader<Note>::attach(again(segment)));
  EXPECT_TRUE(writer.loan());
  EXPECT_EQ(RealAtomics::load(words.wait(0), std::memory_order_relaxed) & kWaiting, 0u);
}

}  // namespace
}  // namespace handcast::ipc
