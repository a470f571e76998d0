// SPDX-License-Identifier: Apache-2.0
// Weakens each memory order of the protocol and breaks each of its rules, one at a time: the
// explorer must find a broken property. Orders without effect are asserted to be redundant.
// HANDCAST_TRACE=1 prints the steps to each broken property.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "tests/ipc/explorer/stories.hpp"

namespace handcast::explorer {
namespace {

using ipc::holds_message, ipc::kWriting, ipc::sequence_of, ipc::state_word;
constexpr auto kRelaxed = std::memory_order_relaxed;
constexpr auto kAcquire = std::memory_order_acquire;
constexpr auto kRelease = std::memory_order_release;

bool is_mark(std::uint64_t state) { return state & kWriting; }
bool is_abandoned(std::uint64_t state) { return !(state & kWriting) && sequence_of(state) == 0; }
bool takes_lease(std::uint64_t lease) { return ipc::slot_of_lease(lease) >= 0; }
bool ends_lease(std::uint64_t lease) { return ipc::slot_of_lease(lease) < 0; }

// Faults that weaken a memory order or drop a fence.
Fault weaker(Role role, Operation operation, Kind kind, std::memory_order order = kRelaxed) {
  return {.role = role, .operation = operation, .kind = kind, .order = order};
}
Fault without_fence(Role role, Kind after) {
  return {.role = role, .operation = Operation::fence, .kind = after, .dropped = true};
}
Fault weaker_fence(Role role, Kind after, std::memory_order order) {
  return weaker(role, Operation::fence, after, order);
}

void expect_found(const stories::Made& story, Faults faults, const std::string& what) {
  story->plant(std::move(faults));
  const auto found = story->explore();
  EXPECT_EQ(found.broken, what);
  if (std::getenv("HANDCAST_TRACE")) std::cout << found.broken << "\n" << found.trace;
}

void expect_redundant(const stories::Made& story, Faults faults) {
  story->plant(std::move(faults));
  const auto found = story->explore();
  EXPECT_EQ(found.broken, "") << found.trace;
  EXPECT_TRUE(found.is_complete);
}

const std::string kTorn = "a torn or wrong message is accepted";
const std::string kRace = "a payload is written while a lease reads it";
const std::string kTwice = "a sequence is given twice";
const std::string kLostWakeUp =
    "a wake-up is lost: a reader sleeps for ever, with a message unseen";
const std::string kNoneFree = "a reader has no free lease although it holds less than it may";
/// Also if another process has changed a lease word of the reader, which can then take no lease.
const std::string kStarves = "a reader starves although nothing newer was published";
const std::string kLost = "a message was published that no reader will find";

// ---- A torn message is detected.

TEST(Mark, NeedsTheFenceBeforeThePayload) {
  expect_found(stories::copying(), {without_fence(Role::writer, Kind::state)}, kTorn);
}
TEST(Mark, IsNotHelpedByARelease) {
  Fault release = weaker(Role::writer, Operation::store, Kind::state, kRelease);
  release.when = is_mark;
  expect_found(stories::copying(), {without_fence(Role::writer, Kind::state), release}, kTorn);
}
TEST(Mark, MustNotBeLeftOut) {
  expect_found(stories::copying(),
               {{.role = Role::writer,
                 .operation = Operation::store,
                 .kind = Kind::state,
                 .when = is_mark,
                 .dropped = true}},
               kTorn);
}
TEST(SecondLook, NeedsTheFenceAfterTheCopy) {
  expect_found(stories::copying(), {without_fence(Role::reader, Kind::payload)}, kTorn);
}
TEST(SecondLook, IsNotHelpedByAnAcquire) {
  Fault acquire = weaker(Role::reader, Operation::load, Kind::state, kAcquire);
  acquire.after = Place{Operation::load, Kind::payload};
  expect_found(stories::copying(), {without_fence(Role::reader, Kind::payload), acquire}, kTorn);
}
TEST(State, IsStoredWithRelease) {
  expect_found(stories::leasing(),
               {weaker(Role::writer, Operation::store, Kind::state),
                weaker(Role::writer, Operation::store, Kind::head)},
               kRace);
}
TEST(State, IsLoadedWithAcquire) {
  expect_found(stories::copying(),
               {weaker(Role::reader, Operation::load, Kind::state),
                weaker(Role::reader, Operation::load, Kind::head)},
               kTorn);
}
TEST(Head, IsStoredWithRelease) {
  expect_found(stories::copying(), {weaker(Role::writer, Operation::store, Kind::head)}, kStarves);
}
TEST(Head, IsLoadedWithAcquire) {
  expect_found(stories::copying(), {weaker(Role::reader, Operation::load, Kind::head)}, kStarves);
}
TEST(State, IsStoredAfterThePayload) {
  expect_found(stories::writer_dies_before_one_copy(),
               {{.role = Role::writer,
                 .operation = Operation::store,
                 .kind = Kind::payload,
                 .overtaken_by = {{Operation::store, Kind::state}}}},
               kTorn);
}
TEST(Abandon, MustNotBringTheOldMessageBack) {
  const auto restores = [](std::uint64_t newest, std::uint64_t) { return newest & ~kWriting; };
  expect_found(stories::abandoning(),
               {{.role = Role::writer,
                 .operation = Operation::store,
                 .kind = Kind::state,
                 .when = is_abandoned,
                 .instead = restores}},
               kTorn);
}

// ---- A lease and a loan exclude each other.

TEST(Lease, NeedsItsFence) {
  expect_found(stories::leasing_with_fewer_slots_than_leases(),
               {without_fence(Role::reader, Kind::lease)}, kRace);
}
TEST(Lease, IsNotHelpedByAnExchangeOfAnyOrder) {
  Fault strong = weaker(Role::reader, Operation::exchange, Kind::lease, std::memory_order_acq_rel);
  expect_found(stories::leasing_with_fewer_slots_than_leases(),
               {without_fence(Role::reader, Kind::lease), strong}, kRace);
}
TEST(Lease, NeedsMoreThanAnAcquireReleaseFence) {
  expect_found(stories::leasing_with_fewer_slots_than_leases(),
               {weaker_fence(Role::reader, Kind::lease, std::memory_order_acq_rel)}, kRace);
}
TEST(Lease, IsTakenByReadModifyWrite) {
  Fault plain = weaker(Role::reader, Operation::exchange, Kind::lease);
  plain.plain_store = true;
  plain.when = takes_lease;
  expect_found(stories::leasing_with_fewer_slots_than_leases(), {plain}, kRace);
}
TEST(Loan, NeedsMoreThanAReleaseFence) {
  expect_found(stories::leasing_with_fewer_slots_than_leases(),
               {weaker_fence(Role::writer, Kind::state, kRelease)}, kRace);
}
TEST(Loan, ScansWithAcquire) {
  expect_found(stories::leasing_with_fewer_slots_than_leases(),
               {weaker(Role::writer, Operation::load, Kind::lease)}, kRace);
}
TEST(Loan, ScansAfterTheMark) {
  expect_found(
      stories::leasing_with_fewer_slots_than_leases(),
      {{.role = Role::writer,
        .operation = Operation::store,
        .kind = Kind::state,
        .when = is_mark,
        .overtaken_by = {{Operation::fence, Kind::state}, {Operation::load, Kind::lease}}}},
      kRace);
}
TEST(Loan, NeverTakesTheNewest) {
  const auto other_slot = [](std::uint64_t, std::uint64_t head) {
    return head ^ std::uint64_t{1} << 56;
  };
  expect_found(stories::writer_dies_before_one_copy(),
               {{.role = Role::writer,
                 .operation = Operation::load,
                 .kind = Kind::head,
                 .instead = other_slot}},
               kStarves);
}
TEST(Release, NeedsItsOrder) {
  Fault relaxed = weaker(Role::reader, Operation::exchange, Kind::lease);
  relaxed.when = ends_lease;
  expect_found(stories::leasing_with_fewer_slots_than_leases(), {relaxed}, kRace);
}
TEST(Release, ComparesBeforeItStores) {
  Fault plain = weaker(Role::reader, Operation::exchange, Kind::lease, kRelease);
  plain.plain_store = true;
  plain.when = ends_lease;
  expect_found(stories::living_reader_is_taken_for_dead(), {plain}, kStarves);
}
TEST(TwoLeasesOfOneReader, NeedTheScanToAcquire) {
  expect_found(stories::two_leases_with_few_slots(),
               {weaker(Role::writer, Operation::load, Kind::lease)}, kRace);
}

// ---- No wake-up is lost.

TEST(WakeUp, NeedsTheWritersFence) {
  expect_found(stories::waiting(), {without_fence(Role::writer, Kind::head)}, kLostWakeUp);
}
TEST(WakeUp, NeedsMoreThanAReleaseFence) {
  expect_found(stories::waiting(),
               {weaker_fence(Role::writer, Kind::head, std::memory_order_acq_rel)}, kLostWakeUp);
}
TEST(WakeUp, ComesAfterTheHead) {
  expect_found(stories::waiting(),
               {{.role = Role::writer,
                 .operation = Operation::store,
                 .kind = Kind::head,
                 .overtaken_by = {{Operation::fence, Kind::state},
                                  {Operation::load, Kind::wait},
                                  {Operation::wake, Kind::head}}}},
               kLostWakeUp);
}
TEST(WakeUp, NeedsTheFlag) {
  expect_found(stories::waiting(),
               {{.role = Role::reader,
                 .operation = Operation::exchange,
                 .kind = Kind::wait,
                 .dropped = true}},
               kLostWakeUp);
}
TEST(Successor, WakesWhomItsPredecessorDidNot) {
  Fault silent{.role = Role::writer,
               .operation = Operation::wake,
               .kind = Kind::head,
               .after = Place{Operation::store, Kind::epoch},
               .dropped = true};
  expect_found(stories::writer_dies_before_sleepers(), {silent}, kLostWakeUp);
}

// ---- A writer's successor.

TEST(Successor, LooksAtTheStatesAndNotAtHeadAlone) {
  const auto nothing_there = [](std::uint64_t, std::uint64_t state) {
    return state & ~ipc::kSequenceMask;
  };
  expect_found(stories::writer_dies_before_one_copy(),
               {{.role = Role::writer,
                 .operation = Operation::load,
                 .kind = Kind::state,
                 .instead = nothing_there}},
               kTwice);
}
TEST(Successor, RollsHeadForward) {
  Fault stays{.role = Role::writer,
              .operation = Operation::store,
              .kind = Kind::head,
              .after = Place{Operation::load, Kind::state},
              .dropped = true};
  expect_found(stories::writer_dies_before_sleepers(), {stays}, kLost);
}
TEST(Successor, NeverRepairsAMarkedSlot) {
  const auto repaired = [](std::uint64_t, std::uint64_t state) { return state & ~kWriting; };
  expect_found(stories::writer_dies_before_a_lease_and_a_copy(),
               {{.role = Role::writer,
                 .operation = Operation::load,
                 .kind = Kind::state,
                 .instead = repaired}},
               kTorn);
}

// ---- A row changes its owner.

TEST(Claim, ReleasesWhatTheDeadOneRead) {
  expect_found(stories::writer_and_reader_die(),
               {weaker(Role::recoverer, Operation::exchange, Kind::lease)}, kRace);
}
TEST(Claim, ComparesBeforeItClears) {
  Fault plain = weaker(Role::recoverer, Operation::exchange, Kind::lease, kRelease);
  plain.plain_store = true;
  expect_found(stories::two_recover_at_once(), {plain}, kStarves);
}
TEST(Claim, ComparesTheOwner) {
  Fault plain =
      weaker(Role::recoverer, Operation::exchange, Kind::owner, std::memory_order_acq_rel);
  plain.plain_store = true;
  expect_found(stories::two_want_the_row_of_the_dead(), {plain}, kStarves);
}
TEST(Claim, ClearsTheLeases) {
  expect_found(stories::two_recover_at_once(),
               {{.role = Role::recoverer,
                 .operation = Operation::exchange,
                 .kind = Kind::lease,
                 .dropped = true}},
               kNoneFree);
}

// ---- Redundant orders. They are kept because they cost nothing and keep each argument short.

TEST(Redundant, TheReadersFenceBeforeItSleepsBecauseTheKernelHasOne) {
  expect_redundant(stories::waiting(), {without_fence(Role::reader, Kind::wait)});
}
TEST(Redundant, TheReleaseOfAStateAsLongAsHeadHasOne) {
  expect_redundant(stories::leasing(), {weaker(Role::writer, Operation::store, Kind::state)});
  expect_redundant(stories::writer_dies_on_a_ring_with_history(),
                   {weaker(Role::writer, Operation::store, Kind::state)});
}
TEST(Redundant, TheAcquireOfAStateAsLongAsHeadHasOne) {
  expect_redundant(stories::copying_the_first_of_many(),
                   {weaker(Role::reader, Operation::load, Kind::state)});
  expect_redundant(stories::looking_back(), {weaker(Role::reader, Operation::load, Kind::state)});
}
TEST(Redundant, TheAcquiresOfALeaseBecauseItsFenceIsOne) {
  expect_redundant(stories::leasing(), {weaker(Role::reader, Operation::load, Kind::state),
                                        weaker(Role::reader, Operation::load, Kind::head)});
}
TEST(Redundant, TheAcquiresOfASuccessorBecauseItsLockIsOne) {
  expect_redundant(stories::writer_dies_before_a_lease_and_a_copy(),
                   {weaker(Role::writer, Operation::load, Kind::state),
                    weaker(Role::writer, Operation::load, Kind::head),
                    weaker(Role::writer, Operation::load, Kind::epoch)});
}
TEST(Redundant, TheOrdersOfAnOwnerBecauseEachWordHasAGeneration) {
  expect_redundant(stories::row_changes_hands(),
                   {weaker(Role::recoverer, Operation::load, Kind::owner),
                    weaker(Role::recoverer, Operation::exchange, Kind::owner),
                    weaker(Role::reader, Operation::exchange, Kind::owner)});
}

}  // namespace
}  // namespace handcast::explorer
