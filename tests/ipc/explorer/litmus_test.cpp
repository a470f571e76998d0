// SPDX-License-Identifier: Apache-2.0
// Tests of the memory model: the allowed and forbidden outcomes of the classic litmus tests.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "tests/ipc/explorer/model_atomics.hpp"
#include "tests/ipc/explorer/search.hpp"

namespace handcast::explorer {
namespace {

constexpr auto relaxed = std::memory_order_relaxed;
constexpr auto acquire = std::memory_order_acquire;
constexpr auto release = std::memory_order_release;
constexpr auto acq_rel = std::memory_order_acq_rel;
constexpr auto seq_cst = std::memory_order_seq_cst;

constexpr int kX = 0, kY = 1;
std::uint64_t load(int location, std::memory_order order) { return machine->load(location, order); }
void store(int location, std::uint64_t value, std::memory_order order) {
  machine->store(location, value, order);
}
bool exchange(int location, std::uint64_t from, std::uint64_t to, std::memory_order order) {
  return machine->exchange(location, from, to, order);
}
void fence(std::memory_order order) { machine->fence(order); }

/// The values that a thread has read.
struct Registers {
  std::uint64_t a, b;
};
using Outcome = std::array<int, 4>;  ///< a, b of the first reading thread, a, b of the second one
using Outcomes = std::set<Outcome>;

struct TestThread {
  bool (*operation)(void*);
  bool reads;
};

template <class Body>
bool run(void* locals) {
  Body{}(*static_cast<Registers*>(locals));
  return false;
}
template <class Body>
TestThread reads(Body) {
  return {run<Body>, true};
}
template <class Body>
TestThread writes(Body) {
  return {run<Body>, false};
}

Outcome outcome_of(const State& state, const std::vector<TestThread>& threads) {
  Outcome outcome{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    if (!threads[i].reads) continue;
    Registers registers;
    std::memcpy(&registers, state.threads[i].locals, sizeof registers);
    outcome.at(at++) = static_cast<int>(registers.a);
    outcome.at(at++) = static_cast<int>(registers.b);
  }
  return outcome;
}

Outcomes ends_of(const std::vector<TestThread>& threads, bool every_order) {
  Machine here;
  machine = &here;
  here.try_every_order(every_order);
  here.add_location("x", Kind::other);
  here.add_location("y", Kind::other);
  State start;
  std::memset(static_cast<void*>(&start), 0, sizeof start);
  start.memory.length[kX] = start.memory.length[kY] = 1;
  for (const auto& thread : threads) {
    Program program;
    program.name = "thread " + std::to_string(here.threads());
    program.operation = thread.operation;
    program.reads = program.writes = bit(kX) | bit(kY);
    program.is_read_at_end = true;
    start.threads[here.add(program)].status = Status::running;
  }
  here.close();
  Outcomes outcomes;
  const auto found = explore(here, start, [&](const State& state) -> const char* {
    outcomes.insert(outcome_of(state, threads));
    return nullptr;
  });
  EXPECT_TRUE(found.is_complete);
  machine = nullptr;
  return outcomes;
}

/// All outcomes. They must be the same with and without the reductions of the search.
Outcomes outcomes_of(const std::vector<TestThread>& threads) {
  const auto outcomes = ends_of(threads, false);
  EXPECT_EQ(outcomes, ends_of(threads, true)) << "a reduction loses outcomes";
  return outcomes;
}

void expect_allowed(const std::vector<TestThread>& threads, const Outcome& outcome) {
  EXPECT_TRUE(outcomes_of(threads).contains(outcome));
}
void expect_forbidden(const std::vector<TestThread>& threads, const Outcome& outcome) {
  const auto outcomes = outcomes_of(threads);
  EXPECT_FALSE(outcomes.contains(outcome));
  EXPECT_GT(outcomes.size(), 1u) << "the test must have several outcomes";
}

// Store buffering: x = 1; read y | y = 1; read x. A Dekker protocol must exclude that both read 0.

TEST(StoreBuffering, BothMayReadOldValuesInSpiteOfAcquireAndRelease) {
  expect_allowed({reads([](Registers& r) { store(kX, 1, release), r.a = load(kY, acquire); }),
                  reads([](Registers& r) { store(kY, 1, release), r.a = load(kX, acquire); })},
                 {0, 0, 0, 0});
}
TEST(StoreBuffering, TwoSeqCstFencesExcludeIt) {
  expect_forbidden(
      {reads([](Registers& r) { store(kX, 1, relaxed), fence(seq_cst), r.a = load(kY, relaxed); }),
       reads([](Registers& r) { store(kY, 1, relaxed), fence(seq_cst), r.a = load(kX, relaxed); })},
      {0, 0, 0, 0});
}
TEST(StoreBuffering, OneSeqCstFenceDoesNot) {
  expect_allowed(
      {reads([](Registers& r) { store(kX, 1, relaxed), fence(seq_cst), r.a = load(kY, relaxed); }),
       reads([](Registers& r) { store(kY, 1, relaxed), r.a = load(kX, relaxed); })},
      {0, 0, 0, 0});
}
TEST(StoreBuffering, FencesOfAcquireAndReleaseDoNot) {
  expect_allowed(
      {reads([](Registers& r) { store(kX, 1, relaxed), fence(acq_rel), r.a = load(kY, relaxed); }),
       reads([](Registers& r) { store(kY, 1, relaxed), fence(acq_rel), r.a = load(kX, relaxed); })},
      {0, 0, 0, 0});
}
TEST(StoreBuffering, AReadModifyWriteDoesNotReplaceAFence) {
  expect_allowed(
      {reads([](Registers& r) { store(kX, 1, relaxed), fence(seq_cst), r.a = load(kY, relaxed); }),
       reads([](Registers& r) { exchange(kY, 0, 1, acq_rel), r.a = load(kX, acquire); })},
      {0, 0, 0, 0});
}

// Message passing: x = 1 (the message); y = 1 (the flag) | read y; read x. To read 1 and then 0 is
// to see the flag but not the message.

TEST(MessagePassing, RelaxedShowsTheFlagBeforeTheMessage) {
  expect_allowed({writes([](Registers&) { store(kX, 1, relaxed), store(kY, 1, relaxed); }),
                  reads([](Registers& r) { r.a = load(kY, relaxed), r.b = load(kX, relaxed); })},
                 {1, 0, 0, 0});
}
TEST(MessagePassing, ReleaseAndAcquireDoNot) {
  expect_forbidden({writes([](Registers&) { store(kX, 1, relaxed), store(kY, 1, release); }),
                    reads([](Registers& r) { r.a = load(kY, acquire), r.b = load(kX, relaxed); })},
                   {1, 0, 0, 0});
}
TEST(MessagePassing, ReleaseAloneIsNotEnough) {
  expect_allowed({writes([](Registers&) { store(kX, 1, relaxed), store(kY, 1, release); }),
                  reads([](Registers& r) { r.a = load(kY, relaxed), r.b = load(kX, relaxed); })},
                 {1, 0, 0, 0});
}
TEST(MessagePassing, AcquireAloneIsNotEnough) {
  expect_allowed({writes([](Registers&) { store(kX, 1, relaxed), store(kY, 1, relaxed); }),
                  reads([](Registers& r) { r.a = load(kY, acquire), r.b = load(kX, relaxed); })},
                 {1, 0, 0, 0});
}
TEST(MessagePassing, TwoFencesMeet) {
  expect_forbidden(
      {writes([](Registers&) { store(kX, 1, relaxed), fence(release), store(kY, 1, relaxed); }),
       reads(
           [](Registers& r) { r.a = load(kY, relaxed), fence(acquire), r.b = load(kX, relaxed); })},
      {1, 0, 0, 0});
}
TEST(MessagePassing, AReleaseFenceMeetsAnAcquireLoad) {
  expect_forbidden(
      {writes([](Registers&) { store(kX, 1, relaxed), fence(release), store(kY, 1, relaxed); }),
       reads([](Registers& r) { r.a = load(kY, acquire), r.b = load(kX, relaxed); })},
      {1, 0, 0, 0});
}
TEST(MessagePassing, AFenceAfterTheFlagIsTooLate) {
  expect_allowed(
      {writes([](Registers&) { store(kX, 1, relaxed), store(kY, 1, relaxed), fence(release); }),
       reads([](Registers& r) { r.a = load(kY, acquire), r.b = load(kX, relaxed); })},
      {1, 0, 0, 0});
}
TEST(MessagePassing, AnAcquireFenceBeforeTheFlagIsTooEarly) {
  expect_allowed({writes([](Registers&) { store(kX, 1, relaxed), store(kY, 1, release); }),
                  reads([](Registers& r) {
                    fence(acquire), r.a = load(kY, relaxed), r.b = load(kX, relaxed);
                  })},
                 {1, 0, 0, 0});
}

// A small sequence lock: x = 1 (the mark); y = 1 (the payload) | read y; read x. To read 1 and then
// 0 is to accept a torn copy.

TEST(Mark, AReleaseStoreDoesNotKeepWhatFollowsBehindIt) {
  expect_allowed({writes([](Registers&) { store(kX, 1, release), store(kY, 1, relaxed); }),
                  reads([](Registers& r) {
                    r.a = load(kY, relaxed), fence(acquire), r.b = load(kX, relaxed);
                  })},
                 {1, 0, 0, 0});
}
TEST(Mark, AnAcquireLoadDoesNotKeepWhatPrecedesBeforeIt) {
  expect_allowed(
      {writes([](Registers&) { store(kX, 1, relaxed), fence(release), store(kY, 1, relaxed); }),
       reads([](Registers& r) { r.a = load(kY, relaxed), r.b = load(kX, acquire); })},
      {1, 0, 0, 0});
}

// Release sequences of C++20: only read-modify-writes continue one.

TEST(ReleaseSequence, APlainStoreOnTopEndsIt) {
  expect_allowed({writes([](Registers&) {
                    store(kX, 1, relaxed), store(kY, 1, release), store(kY, 2, relaxed);
                  }),
                  reads([](Registers& r) { r.a = load(kY, acquire), r.b = load(kX, relaxed); })},
                 {2, 0, 0, 0});
}
TEST(ReleaseSequence, AReadModifyWriteOnTopKeepsIt) {
  expect_forbidden({writes([](Registers&) {
                      store(kX, 1, relaxed), store(kY, 1, release), exchange(kY, 1, 2, relaxed);
                    }),
                    reads([](Registers& r) { r.a = load(kY, acquire), r.b = load(kX, relaxed); })},
                   {2, 0, 0, 0});
}
TEST(ReleaseSequence, AnothersReadModifyWriteKeepsItToo) {
  expect_forbidden({writes([](Registers&) { store(kX, 1, relaxed), store(kY, 1, release); }),
                    writes([](Registers&) { exchange(kY, 1, 2, relaxed); }),
                    reads([](Registers& r) { r.a = load(kY, acquire), r.b = load(kX, relaxed); })},
                   {2, 0, 0, 0});
}

// Coherence: all threads see the stores to one location in the same order.

TEST(Coherence, AReaderNeverGoesBack) {
  expect_forbidden({writes([](Registers&) { store(kX, 1, relaxed), store(kX, 2, relaxed); }),
                    reads([](Registers& r) { r.a = load(kX, relaxed), r.b = load(kX, relaxed); })},
                   {2, 1, 0, 0});
}
TEST(Coherence, AReaderMayStayBehind) {
  expect_allowed({writes([](Registers&) { store(kX, 1, relaxed), store(kX, 2, relaxed); }),
                  reads([](Registers& r) { r.a = load(kX, relaxed), r.b = load(kX, relaxed); })},
                 {1, 1, 0, 0});
}
TEST(Coherence, AThreadSeesItsOwnStore) {
  expect_forbidden({writes([](Registers&) { store(kY, 1, relaxed); }), reads([](Registers& r) {
                      store(kX, 1, relaxed), r.a = load(kX, relaxed), r.b = load(kY, relaxed);
                    })},
                   {0, 0, 0, 0});
}
TEST(Coherence, OnlyOneOfTwoExchangesSucceeds) {
  expect_forbidden({reads([](Registers& r) { r.a = exchange(kX, 0, 1, relaxed); }),
                    reads([](Registers& r) { r.a = exchange(kX, 0, 2, relaxed); })},
                   {1, 0, 1, 0});
}

// Independent reads of independent writes: whether two readers may see two stores in opposite
// orders.

TEST(IndependentReads, MayDisagreeUnderAcquire) {
  expect_allowed({writes([](Registers&) { store(kX, 1, release); }),
                  writes([](Registers&) { store(kY, 1, release); }),
                  reads([](Registers& r) { r.a = load(kX, acquire), r.b = load(kY, acquire); }),
                  reads([](Registers& r) { r.a = load(kY, acquire), r.b = load(kX, acquire); })},
                 {1, 0, 1, 0});
}
TEST(IndependentReads, AgreeWithSeqCstFences) {
  expect_forbidden({writes([](Registers&) { store(kX, 1, release); }),
                    writes([](Registers&) { store(kY, 1, release); }), reads([](Registers& r) {
                      r.a = load(kX, relaxed), fence(seq_cst), r.b = load(kY, relaxed);
                    }),
                    reads([](Registers& r) {
                      r.a = load(kY, relaxed), fence(seq_cst), r.b = load(kX, relaxed);
                    })},
                   {1, 0, 1, 0});
}

// An outcome that is possible on real machines but not in this model: see memory_model.hpp.

TEST(LimitOfTheModel, NoLoadSeesAStoreThatComesLaterInItsOwnThread) {
  expect_forbidden({reads([](Registers& r) { r.a = load(kX, relaxed), store(kY, 1, relaxed); }),
                    reads([](Registers& r) { r.a = load(kY, relaxed), store(kX, 1, relaxed); })},
                   {1, 0, 1, 0});
}

}  // namespace
}  // namespace handcast::explorer
