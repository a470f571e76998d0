// SPDX-License-Identifier: Apache-2.0
// Numbers that wrap around: sequences, epochs, generations.
#include <gtest/gtest.h>

#include "ipc/ring/ring_view.hpp"
#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace handcast::ipc::samples;

constexpr auto kLast = kSequenceMask;

TEST(Wrap, LaterAndHowManyAreTrueAcrossTheLastSequence) {
  EXPECT_TRUE(is_later(2, 1) && is_later(1, kLast) && is_later(5, kLast - 5) &&
              is_later(kLast, kLast - 1));
  EXPECT_FALSE(is_later(1, 2) || is_later(kLast, 1) || is_later(7, 7) || is_later(kLast, kLast));
  EXPECT_TRUE(is_later(1, 0) && is_later(kLast, 0)) << "any sequence is later than none";
  EXPECT_FALSE(is_later(0, 1) || is_later(0, kLast) || is_later(0, 0));
  EXPECT_EQ(following(kLast), 1u);
  EXPECT_EQ(given_between(kLast, 1), 1u);
  EXPECT_EQ(given_between(kLast - 1, 2), 3u);
  EXPECT_EQ(given_between(0, 3), 3u);
  EXPECT_EQ(given_between(9, 9), 0u);
  EXPECT_EQ(following_epoch(kEpochMask), 1u);
}

/// A ring whose newest message has this sequence and is in slot 0.
Segment ring_at(std::uint64_t sequence, int slots, bool keep_history) {
  auto segment = make_ring<Note>(slots, keep_history);
  const auto words = control_words_of(segment);
  RealAtomics::store(words.state(0), state_word(3, sequence), std::memory_order_seq_cst);
  RealAtomics::store(words.head(), head_word(0, sequence), std::memory_order_seq_cst);
  return segment;
}

TEST(Wrap, ReadersGoOnPastTheLastSequence) {
  const auto segment = ring_at(kLast - 3, 16, true);
  auto next = must(Reader<Note>::attach(again(segment)));
  auto latest = must(Reader<Note>::attach(again(segment)));
  auto slow = must(Reader<Note>::attach(again(segment)));
  auto leasing = must(Reader<Note>::attach(again(segment), Wait::futex, Hold::lease));
  for (auto* reader : {&next, &latest, &slow, &leasing})
    EXPECT_EQ(must(reader->next(kNow)).sequence(), kLast - 3);
  auto writer = must(Writer<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 8; ++i) {
    writer.publish(note(i, static_cast<std::int64_t>(i) * 10));
    for (auto* reader : {&next, &leasing}) {
      const auto sample = must(reader->next(kNow));
      EXPECT_EQ(sample->value, i);
      EXPECT_EQ(sample.sequence(), i <= 3 ? kLast - 3 + i : i - 3);
    }
    EXPECT_EQ(must(latest.latest(kNow))->value, i);
    EXPECT_EQ(latest.latest(kNow).error().code, Errc::timeout);
  }
  EXPECT_EQ(next.skipped() + latest.skipped() + leasing.skipped(), 0u);
  EXPECT_EQ(must(slow.latest(kNow))->value, 8u);
  EXPECT_EQ(slow.skipped(), 7u);
  EXPECT_EQ(must(slow.at(31))->value, 3u);
}

TEST(Wrap, ALateReaderOfAHistoryBeginsBeforeTheLastSequence) {
  const auto segment = ring_at(kLast - 1, 8, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 5; ++i) writer.publish(note(i));
  auto reader = must(Reader<Note>::attach(again(segment)));
  EXPECT_EQ(must(reader.next(kNow)).sequence(), kLast - 1);
  for (std::uint64_t i = 1; i <= 5; ++i) EXPECT_EQ(must(reader.next(kNow))->value, i);
  EXPECT_EQ(reader.skipped(), 0u);
}

TEST(Wrap, AReaderSkipsAcrossTheLastSequenceAndCountsIt) {
  const auto segment = ring_at(kLast - 1, 4, true);
  auto reader = must(Reader<Note>::attach(again(segment)));
  EXPECT_TRUE(reader.next(kNow));
  auto writer = must(Writer<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 9; ++i) writer.publish(note(i));
  EXPECT_EQ(must(reader.next(kNow))->value, 6u);
  EXPECT_EQ(reader.skipped(), 5u);
}

TEST(Wrap, AWriterThatComesAfterTheLastSequenceContinuesTheNewestNotTheLargest) {
  const auto segment = ring_at(kLast - 1, 8, true);
  auto reader = must(Reader<Note>::attach(again(segment)));
  std::uint64_t expected = kLast - 1;
  for (std::uint64_t life = 1; life <= 5; ++life) {
    EXPECT_EQ(must(reader.next(kNow)).sequence(), expected);
    must(Writer<Note>::attach(again(segment))).publish(note(life));
    expected = following(expected);
  }
  EXPECT_EQ(expected, 4u);
  EXPECT_EQ(must(reader.next(kNow))->value, 5u);
  EXPECT_EQ(reader.skipped(), 0u);
}

TEST(Wrap, AHeadThatWasNotMovedIsRolledForwardAcrossTheLastSequence) {
  const auto segment = ring_at(kLast, 4, false);
  auto reader = must(Reader<Note>::attach(again(segment)));
  EXPECT_TRUE(reader.next(kNow));
  RealAtomics::store(control_words_of(segment).state(2), state_word(3, 1),
                     std::memory_order_seq_cst);
  auto writer = must(Writer<Note>::attach(again(segment)));
  EXPECT_EQ(must(reader.next(kNow)).sequence(), 1u);
  writer.publish(note(2));
  EXPECT_EQ(must(reader.next(kNow)).sequence(), 2u);
}

TEST(Wrap, EpochsGoOnPastTheLastOneAndLeaveOutZero) {
  const auto segment = make_ring<Note>(4);
  auto reader = must(Reader<Note>::attach(again(segment)));
  const auto view = must(RingView::open(duplicate(segment.fd())));
  RealAtomics::store(control_words_of(segment).epoch(), kEpochMask - 2, std::memory_order_seq_cst);
  for (const auto epoch :
       {kEpochMask - 1, kEpochMask, std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3}}) {
    must(Writer<Note>::attach(again(segment))).publish(note(epoch));
    EXPECT_EQ(must(reader.next(kNow)).epoch(), epoch);
    EXPECT_EQ(view.epoch(), epoch);
  }
}

TEST(Wrap, ARowIsTakenAndClearedPastItsLastGeneration) {
  const auto segment = make_ring<Strip>(4);
  const auto words = control_words_of(segment);
  RealAtomics::store(words.owner(0), free_word(0xffff), std::memory_order_seq_cst);
  RealAtomics::store(words.wait(0), free_word(0xffff) | kWaiting, std::memory_order_seq_cst);
  RealAtomics::store(words.lease(0, 0), lease_word(0xffff, 1, 1), std::memory_order_seq_cst);
  RealAtomics::store(words.lease(0, 1), free_word(0xfffe), std::memory_order_seq_cst);
  auto reader = must(Reader<Strip>::attach(again(segment)));
  EXPECT_EQ(generation_of(RealAtomics::load(words.owner(0), std::memory_order_seq_cst)), 0u);
  for (const auto* word : {&words.wait(0), &words.lease(0, 0), &words.lease(0, 1)})
    EXPECT_EQ(RealAtomics::load(*word, std::memory_order_seq_cst), free_word(0));
  auto writer = must(Writer<Strip>::attach(again(segment)));
  writer.publish(writer.loan());
  EXPECT_TRUE(must(reader.next(kNow)).leased());
}

}  // namespace
}  // namespace handcast::ipc
