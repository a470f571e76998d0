// SPDX-License-Identifier: Apache-2.0
// The protocol under every order of steps, every late store and every death. Each test explores one
// story completely.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/ipc/explorer/stories.hpp"

namespace handcast::explorer {
namespace {

void expect_clean(const stories::Made& story) {
  const auto found = story->explore();
  EXPECT_EQ(found.broken, "") << found.trace;
  EXPECT_TRUE(found.is_complete);
  EXPECT_GT(found.ends, 0u);
  std::cout << found.states << " states, " << found.steps << " steps, longest path " << found.depth
            << "\n";
}

TEST(Copying, NoTornMessageIsAccepted) { expect_clean(stories::copying()); }
TEST(Copying, AReaderThatIsOvertakenGetsANewerMessage) {
  expect_clean(stories::copying_the_first_of_many());
}
TEST(Copying, NoMessageIsMixedOfTwo) { expect_clean(stories::copying_two_words()); }
TEST(Copying, HistoryComesInOrder) { expect_clean(stories::following_in_order()); }
TEST(Copying, TheMessageNearestToATimeIsWhole) { expect_clean(stories::looking_back()); }
TEST(Copying, AnAbandonedSlotIsNeverTakenForItsOldMessage) { expect_clean(stories::abandoning()); }

TEST(Leasing, WithFewerSlotsThanLeasesNothingUnderALeaseIsWritten) {
  expect_clean(stories::leasing_with_fewer_slots_than_leases());
}
TEST(Leasing, NothingUnderALeaseIsWritten) { expect_clean(stories::leasing()); }
TEST(Leasing, WithTwoSlotsMoreThanLeasesALoanNeverFails) {
  expect_clean(stories::leasing_with_slots_enough());
}
TEST(Leasing, GoesTogetherWithCopying) { expect_clean(stories::leasing_beside_a_copy()); }
TEST(Leasing, HistoryComesInOrder) { expect_clean(stories::leasing_in_order()); }
TEST(Leasing, ALoanFindsTheFreeSlotHoweverAReaderMoves) {
  expect_clean(stories::looking_back_under_leases());
}
TEST(TwoLeases, OfOneReaderLeaveTheWriterASlot) {
  expect_clean(stories::two_leases_of_one_reader());
}
TEST(TwoLeases, OfOneReaderGoTogetherWithACopy) {
  expect_clean(stories::two_leases_beside_a_copy());
}
TEST(TwoLeases, AndAnotherReadersOnFewSlotsAreNotWritten) {
  expect_clean(stories::two_leases_with_few_slots());
}

TEST(Waiting, NoWakeUpIsLost) { expect_clean(stories::waiting()); }
TEST(Waiting, NoWakeUpIsLostBetweenLeases) { expect_clean(stories::waiting_for_leases()); }

TEST(AWriterKilledAtAnyStep, LeavesNoTornMessageOnTwoSlots) {
  expect_clean(stories::writer_dies_before_one_copy());
}
TEST(AWriterKilledAtAnyStep, LeavesNoTornMessageBehind) {
  expect_clean(stories::writer_dies_before_copies());
}
TEST(AWriterKilledAtAnyStep, TroublesNeitherALeaseNorACopy) {
  expect_clean(stories::writer_dies_before_a_lease_and_a_copy());
}
TEST(AWriterKilledAtAnyStep, LeavesTwoLeasesAlone) {
  expect_clean(stories::writer_dies_before_leases());
}
TEST(AWriterKilledAtAnyStep, LeavesAHistoryInOrder) {
  expect_clean(stories::writer_dies_on_a_ring_with_history());
}
TEST(AWriterKilledAtAnyStep, IsMadeGoodForSleepersByItsSuccessor) {
  expect_clean(stories::writer_dies_before_sleepers());
}
TEST(AWriterKilledAtAnyStep, MayHaveASuccessorThatIsKilledToo) {
  expect_clean(stories::two_writers_die());
}

TEST(AReaderKilledAtAnyStep, LeavesItsRowToTheNext) {
  expect_clean(stories::leasing_reader_dies());
}
TEST(AReaderKilledAtAnyStep, LeavesTwoLeasesToTheNext) {
  expect_clean(stories::reader_with_two_leases_dies());
}
TEST(AReaderKilledAtAnyStep, LeavesNoFlagThatHarms) {
  expect_clean(stories::waiting_reader_dies());
}
TEST(AReaderKilledAtAnyStep, MayDieBesideItsWriter) {
  expect_clean(stories::writer_and_reader_die());
}

TEST(Rows, OfTheDeadGoToOneOfTwo) { expect_clean(stories::two_want_the_row_of_the_dead()); }
TEST(Rows, AreClearedByTwoAtOnce) { expect_clean(stories::two_recover_at_once()); }
TEST(Rows, ARecovererThatDiesHalfWayIsMadeGood) {
  expect_clean(stories::recoverer_dies_half_way());
}
TEST(Rows, AReaderTakenForDeadHarmsNobody) {
  expect_clean(stories::living_reader_is_taken_for_dead());
}
TEST(Rows, ThatWereGivenBackAreTakenAgain) { expect_clean(stories::row_changes_hands()); }

TEST(WrapAround, OfGenerationsKeepsOwnersApart) {
  expect_clean(stories::generations_wrap_around());
}
TEST(WrapAround, OfEpochsKeepsMessagesApart) { expect_clean(stories::epochs_wrap_around()); }
TEST(WrapAround, OfTheBitsOfFutexAndLeaseLosesNothing) {
  expect_clean(stories::futex_and_lease_sequences_wrap_around());
}

TEST(Reductions, ChangeNoVerdict) {
  for (const auto make : {stories::copying_two_words, stories::waiting_for_leases,
                          stories::row_changes_hands, stories::writer_dies_before_one_copy}) {
    const auto story = make();
    story->try_every_order();
    expect_clean(story);
  }
}

}  // namespace
}  // namespace handcast::explorer
