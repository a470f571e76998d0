// SPDX-License-Identifier: Apache-2.0
// Readers and writers that attach, detach, wait and attach again.
#include <gmock/gmock.h>

#include <optional>
#include <thread>

#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace std::chrono_literals;
using namespace handcast::ipc::samples;
using ::testing::HasSubstr;

TEST(Ring, ASecondWriterIsRefusedWhileTheFirstLives) {
  const auto segment = make_ring<Note>(4);
  auto writer = std::make_unique<Writer<Note>>(must(Writer<Note>::attach(again(segment))));
  const auto second = Writer<Note>::attach(again(segment));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::unavailable);
  EXPECT_THAT(second.error().what, HasSubstr("another writer is attached"));
  writer.reset();
  EXPECT_TRUE(Writer<Note>::attach(again(segment)));
}

TEST(Ring, AWriterThatMayWaitFollowsTheFirstWhenThatLeaves) {
  const auto segment = make_ring<Note>(4);
  std::optional<Writer<Note>> first(must(Writer<Note>::attach(again(segment))));
  EXPECT_FALSE(Writer<Note>::attach(again(segment), Deadline::in(20ms)))
      << "the first did not leave";
  std::jthread leaves([&] {
    sleep_until_ns(now_ns() + to_ns(50ms));
    first.reset();
  });
  auto second = Writer<Note>::attach(again(segment), Deadline::in(60s));
  ASSERT_TRUE(second) << second.error().what;
  second->publish(note(1));
}

TEST(Ring, AWriterStartedAgainContinuesTheSequenceAndRaisesTheEpoch) {
  const auto segment = make_ring<Note>(4);
  auto reader = must(Reader<Note>::attach(again(segment)));
  for (std::uint64_t life = 1; life <= 5; ++life) {
    auto writer = must(Writer<Note>::attach(again(segment)));
    writer.publish(note(life));
    const auto sample = must(reader.next(kNow));
    EXPECT_EQ(sample->value, life);
    EXPECT_EQ(sample.sequence(), life);
    EXPECT_EQ(sample.epoch(), life);
  }
  EXPECT_EQ(reader.skipped(), 0u);
}

TEST(Ring, AMessageWhoseWriterDiedBeforeAnnouncingItIsAnnouncedByTheNextWriter) {
  const auto segment = make_ring<Note>(4);
  must(Writer<Note>::attach(again(segment))).publish(note(1));
  auto reader = must(Reader<Note>::attach(again(segment)));
  EXPECT_TRUE(reader.latest(kNow));
  const auto words = control_words_of(segment);
  reinterpret_cast<Note*>(segment.slot_at(2))->value = 2;
  // Slot 2 is published, but head is not moved; in slot 3 the writer died while writing.
  RealAtomics::store(words.state(2), state_word(1, 2), std::memory_order_seq_cst);
  RealAtomics::store(words.state(3), state_word(1, 3) | kWriting, std::memory_order_seq_cst);
  auto writer = must(Writer<Note>::attach(again(segment)));
  const auto rolled_forward = must(reader.latest(kNow));
  EXPECT_EQ(rolled_forward->value, 2u);
  EXPECT_EQ(RealAtomics::load(words.state(3), std::memory_order_relaxed),
            state_word(1, 3) | kWriting);
  writer.publish(note(3));
  EXPECT_EQ(must(reader.latest(kNow)).sequence(), 3u);
}

TEST(Ring, AnEmptyRingIsATimeoutNotAHang) {
  const auto segment = make_ring<Note>(4);
  for (const auto wait : {Wait::spin, Wait::predictive, Wait::futex, Wait::eventfd}) {
    auto reader = must(Reader<Note>::attach(again(segment), wait));
    for (const auto deadline : {Deadline::now(), Deadline::at_ns(-5), Deadline::at_ns(1),
                                Deadline::in(-1s), Deadline::in(3ms)}) {
      EXPECT_EQ(reader.next(deadline).error().code, Errc::timeout);
      EXPECT_EQ(reader.latest(deadline).error().code, Errc::timeout);
    }
    const auto deadline = Deadline::in(5ms);
    EXPECT_FALSE(reader.next(deadline));
    EXPECT_TRUE(deadline.passed());
  }
}

TEST(Ring, EveryWayOfWaitingSeesMessagesThatComeRegularlyThenLateThenNoMore) {
  const auto segment = make_ring<Note>(8, true);
  for (const auto wait : {Wait::spin, Wait::predictive, Wait::futex, Wait::eventfd}) {
    auto reader = must(Reader<Note>::attach(again(segment), wait));
    while (reader.next(kNow)) continue;
    std::jthread thread([&] {
      auto writer = must(Writer<Note>::attach(again(segment)));
      for (std::uint64_t i = 0; i < 30; ++i) {
        std::this_thread::sleep_for(i == 20 ? 30ms : 2ms);
        writer.publish(note(i));
      }
    });
    std::uint64_t expected = 0;
    while (expected < 30) {
      const auto sample = must(reader.next(Deadline::in(10s)));
      ASSERT_GE(sample->value, expected);
      expected = sample->value + 1;
    }
    EXPECT_EQ(reader.next(Deadline::in(5ms)).error().code, Errc::timeout);
  }
}

TEST(Ring, ThereIsARowForSixteenReadersAndARowGivenBackIsUsedAgain) {
  const auto segment = make_ring<Note>(4);
  std::vector<Reader<Note>> readers;
  for (int i = 0; i < kReaderRows; ++i)
    readers.push_back(must(Reader<Note>::attach(again(segment))));
  const auto one_more = Reader<Note>::attach(again(segment));
  ASSERT_FALSE(one_more);
  EXPECT_EQ(one_more.error().code, Errc::unavailable);
  readers.erase(readers.begin() + 5);
  EXPECT_TRUE(Reader<Note>::attach(again(segment)));
}

TEST(Ring, AReaderDoesNotNeedTheWriterAndMayComeFirst) {
  const auto segment = make_ring<Note>(4);
  auto reader = must(Reader<Note>::attach(again(segment)));
  EXPECT_FALSE(reader.latest(kNow));
  auto writer = must(Writer<Note>::attach(again(segment)));
  EXPECT_FALSE(reader.latest(kNow));
  writer.publish(note(1));
  EXPECT_EQ(must(reader.latest(kNow))->value, 1u);
}

}  // namespace
}  // namespace handcast::ipc
