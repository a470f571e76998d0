// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace handcast::ipc::samples;
using ::testing::HasSubstr;

TEST(Ring, WhatIsPublishedIsRead) {
  const auto segment = make_ring<Note>(4);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  const auto before_ns = now_ns();
  auto loan = writer.loan();
  ASSERT_TRUE(loan);
  EXPECT_EQ(loan->value, 0u);
  loan->header.frame_id = 7;
  loan->header.origin_ns = 1234;
  loan->value = 42;
  writer.publish(std::move(loan));
  const auto sample = must(reader.next(kNow));
  EXPECT_EQ(sample->value, 42u);
  EXPECT_EQ(sample->header.frame_id, 7u);
  EXPECT_EQ(sample->header.origin_ns, 1234);
  EXPECT_GE(sample->header.published_ns, before_ns);
  EXPECT_LE(sample->header.published_ns, now_ns());
  EXPECT_EQ(sample.sequence(), 1u);
  EXPECT_EQ(sample.epoch(), 1u);
  EXPECT_EQ(writer.published(), 1u);
  EXPECT_EQ(reader.received(), 1u);
}

TEST(Ring, ALoanBeginsAsADefaultMessageEvenInAUsedSlot) {
  const auto segment = make_ring<Note>(2);
  auto writer = must(Writer<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 4; ++i) writer.publish(note(i, 99));
  const auto loan = writer.loan();
  ASSERT_TRUE(loan);
  EXPECT_EQ(loan->value, 0u);
  EXPECT_EQ(loan->header.origin_ns, 0);
}

TEST(Ring, NextGivesEveryMessageInOrderWhereHistoryIsKept) {
  const auto segment = make_ring<Note>(8, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 6; ++i) writer.publish(note(i));
  for (std::uint64_t i = 1; i <= 6; ++i) EXPECT_EQ(must(reader.next(kNow))->value, i);
  EXPECT_EQ(reader.next(kNow).error().code, Errc::timeout);
  EXPECT_EQ(reader.received(), 6u);
  EXPECT_EQ(reader.skipped(), 0u);
}

TEST(Ring, ASlowReaderSkipsWhatWasOverwrittenAndCountsIt) {
  const auto segment = make_ring<Note>(4, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  writer.publish(note(1));
  EXPECT_EQ(must(reader.next(kNow))->value, 1u);
  for (std::uint64_t i = 2; i <= 11; ++i) writer.publish(note(i));
  EXPECT_EQ(must(reader.next(kNow))->value, 8u);  // four slots: 8, 9, 10, 11
  EXPECT_EQ(reader.skipped(), 6u);
  EXPECT_EQ(must(reader.latest(kNow))->value, 11u);
  EXPECT_EQ(reader.skipped(), 8u);
  EXPECT_EQ(reader.received(), 3u);
  EXPECT_EQ(reader.latest(kNow).error().code, Errc::timeout);
}

TEST(Ring, ALateReaderSeesTheNewestAtOnceAndOnlyOnce) {
  const auto segment = make_ring<Note>(4);
  auto writer = must(Writer<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 5; ++i) writer.publish(note(i));
  auto latest = must(Reader<Note>::attach(again(segment)));
  auto next = must(Reader<Note>::attach(again(segment)));
  EXPECT_EQ(must(latest.latest(kNow))->value, 5u);
  EXPECT_FALSE(latest.latest(kNow));
  EXPECT_EQ(must(next.next(kNow))->value, 5u);
  EXPECT_EQ(next.skipped() + latest.skipped(), 0u)
      << "messages before a reader attached do not count as skipped";
}

TEST(Ring, ALateReaderOfAHistoryReadsAllThatIsStillThere) {
  const auto segment = make_ring<Note>(4, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 9; ++i) writer.publish(note(i));
  auto reader = must(Reader<Note>::attach(again(segment)));
  for (std::uint64_t i = 6; i <= 9; ++i) EXPECT_EQ(must(reader.next(kNow))->value, i);
  EXPECT_EQ(reader.skipped(), 0u);
}

TEST(Ring, AtFindsTheMessageNearestInTimeAndChangesNothingElse) {
  const auto segment = make_ring<Note>(6, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  EXPECT_EQ(reader.at(0).error().code, Errc::timeout);
  for (std::uint64_t i = 1; i <= 5; ++i)
    writer.publish(note(i, static_cast<std::int64_t>(i) * 1000));
  const std::array<std::pair<std::int64_t, std::uint64_t>, 7> cases{
      {{3000, 3},
       {3400, 3},
       {3600, 4},
       {-5, 1},
       {1'000'000, 5},
       {std::numeric_limits<std::int64_t>::min(), 1},
       {std::numeric_limits<std::int64_t>::max(), 5}}};
  for (const auto& [asked_ns, expected] : cases)
    EXPECT_EQ(must(reader.at(asked_ns))->value, expected) << asked_ns;
  EXPECT_EQ(reader.received(), 0u);
  EXPECT_EQ(must(reader.next(kNow))->value, 1u);
}

TEST(Ring, ATailTravelsWithItsMessageAndNoFurther) {
  const std::size_t room = 1000;
  const auto segment = make_ring<Strip>(2, false, sizeof(Strip) + room);
  auto writer = must(Writer<Strip>::attach(again(segment)));
  auto reader = must(Reader<Strip>::attach(again(segment)));
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{500}, room}) {
    auto loan = writer.loan();
    ASSERT_EQ(loan.tail_bytes(), room);
    loan->tail_length = length;
    for (std::size_t i = 0; i < length; ++i)
      loan->tail()[i] = static_cast<std::uint8_t>(length + i);
    writer.publish(std::move(loan));
    const auto sample = must(reader.next(kNow));
    ASSERT_EQ(sample->tail_length, length);
    for (std::size_t i = 0; i < length; ++i)
      ASSERT_EQ(sample->tail()[i], static_cast<std::uint8_t>(length + i));
  }
}

TEST(Ring, AMessageThatClaimsMoreThanItsSlotIsBadData) {
  const auto segment = make_ring<Strip>(2, false, sizeof(Strip) + 100);
  auto writer = must(Writer<Strip>::attach(again(segment)));
  auto reader = must(Reader<Strip>::attach(again(segment)));
  for (const std::uint64_t claim :
       {std::uint64_t{101}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    auto loan = writer.loan();
    loan->tail_length = claim;
    writer.publish(std::move(loan));
    EXPECT_EQ(reader.at(0).error().code, Errc::bad_data);
    const auto message = reader.next(kNow);
    ASSERT_FALSE(message);
    EXPECT_EQ(message.error().code, Errc::bad_data);
    EXPECT_THAT(message.error().what, HasSubstr("its slot has"));
  }
  EXPECT_EQ(reader.received(), 0u);
  EXPECT_EQ(reader.skipped(), 3u);
}

TEST(Ring, AnAbandonedLoanIsNeverSeenAndItsSlotIsUsedAgain) {
  const auto segment = make_ring<Note>(2);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  writer.publish(note(1));
  for (int i = 0; i < 10; ++i) {
    auto loan = writer.loan();
    ASSERT_TRUE(loan);
    loan->value = 666;
  }
  EXPECT_EQ(must(reader.next(kNow))->value, 1u);
  EXPECT_FALSE(reader.next(kNow));
  writer.publish(note(2));
  const auto sample = must(reader.next(kNow));
  EXPECT_EQ(sample->value, 2u);
  EXPECT_EQ(sample.sequence(), 2u);
}

TEST(Ring, AnOverwrittenMessageDoesNotComeBackWhenItsSlotIsAbandoned) {
  const auto segment = make_ring<Note>(2, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  writer.publish(note(1, 1000));
  writer.publish(note(2, 2000));
  { auto scribble = writer.loan(); }
  EXPECT_EQ(must(reader.at(1000))->value, 2u);
  EXPECT_EQ(must(reader.next(kNow))->value, 2u);
}

TEST(Ring, TheNewestMessageStaysReadableWhileTheNextOneIsWritten) {
  const auto segment = make_ring<Note>(2);
  auto writer = must(Writer<Note>::attach(again(segment)));
  writer.publish(note(1));
  const auto loan = writer.loan();
  loan->value = 2;
  auto reader = must(Reader<Note>::attach(again(segment)));
  EXPECT_EQ(must(reader.latest(kNow))->value, 1u);
}

TEST(Ring, LoansDoNotOverlapAndRunOutWithoutHarm) {
  const auto segment = make_ring<Note>(3);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  writer.publish(note(1));
  auto first = writer.loan();
  auto second = writer.loan();
  ASSERT_TRUE(first && second);
  EXPECT_NE(&*first, &*second);
  EXPECT_FALSE(writer.loan());
  EXPECT_EQ(writer.dropped(), 1u);
  writer.publish(writer.loan());  // an empty loan is ignored
  first->value = 2;
  second->value = 3;
  writer.publish(std::move(second));
  EXPECT_EQ(must(reader.latest(kNow))->value, 3u);
  writer.publish(std::move(first));
  EXPECT_EQ(must(reader.latest(kNow))->value, 2u);
}

TEST(Ring, ALoanTakesTheMostRecentlyFreedSlotOrTheOldestOfAHistory) {
  const auto slots_used = [](bool keep_history) {
    const auto segment = make_ring<Note>(4, keep_history);
    auto writer = must(Writer<Note>::attach(again(segment)));
    std::vector<const Note*> used;
    for (int i = 0; i < 12; ++i) {
      auto loan = writer.loan();
      if (std::find(used.begin(), used.end(), &*loan) == used.end()) used.push_back(&*loan);
      writer.publish(std::move(loan));
    }
    return used.size();
  };
  EXPECT_EQ(slots_used(false), 2u);
  EXPECT_EQ(slots_used(true), 4u);
}

TEST(Ring, ALeasedSlotIsNotWrittenAndWithAllLeasedALoanIsEmpty) {
  const auto segment = make_ring<Note>(3);
  auto writer = must(Writer<Note>::attach(again(segment)));
  const auto words = control_words_of(segment);
  const auto lease = [&](int row, int slot) {
    RealAtomics::store(words.lease(row, 1), lease_word(0, slot, 1), std::memory_order_seq_cst);
  };
  writer.publish(note(1));
  const auto leased = RealAtomics::load(words.state(0), std::memory_order_relaxed);
  lease(3, 0);
  for (std::uint64_t i = 2; i < 10; ++i) writer.publish(note(i));
  EXPECT_EQ(RealAtomics::load(words.state(0), std::memory_order_relaxed), leased);
  EXPECT_EQ(writer.dropped(), 0u);
  lease(4, 1);
  lease(15, 2);
  EXPECT_FALSE(writer.loan());
  EXPECT_EQ(writer.dropped(), 1u);
}

TEST(Ring, SamplesStayValidAndUnchangedWhileTheWriterGoesOn) {
  const auto segment = make_ring<Note>(2);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = std::make_unique<Reader<Note>>(must(Reader<Note>::attach(again(segment))));
  std::vector<Sample<Note>> held;
  for (std::uint64_t i = 1; i <= 5; ++i) {
    writer.publish(note(i));
    held.push_back(must(reader->next(kNow)));
  }
  reader.reset();
  for (std::uint64_t i = 1; i <= 5; ++i) EXPECT_EQ(held[i - 1]->value, i);
}

}  // namespace
}  // namespace handcast::ipc
