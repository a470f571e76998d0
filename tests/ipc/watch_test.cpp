// SPDX-License-Identifier: Apache-2.0
// Reading a ring without a row, through a read-only mapping.
#include <gmock/gmock.h>

#include <cstring>
#include <thread>
#include <vector>

#include "ipc/ring/ring_view.hpp"
#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace std::chrono_literals;
using namespace handcast::ipc::samples;

/// The ring as a program outside the rig gets it: through a descriptor that is only for reading.
Segment for_reading(const Segment& segment) {
  const auto path = "/proc/self/fd/" + std::to_string(segment.fd());
  return must(Segment::open(UniqueFd(::open(path.c_str(), O_RDONLY | O_CLOEXEC))));
}

template <class T>
Reader<T> watcher(const Segment& segment, Wait wait = Wait::futex) {
  return must(Reader<T>::watch(for_reading(segment), wait));
}

/// Everything in the ring but the messages.
std::vector<std::byte> words_of(const Segment& segment) {
  return {segment.data(), segment.slot_at(0)};
}

TEST(Watch, ReadsInOrderTheNewestAndAtATime) {
  const auto segment = make_ring<Note>(8, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 5; ++i)
    writer.publish(note(i, static_cast<std::int64_t>(100 * i)));
  auto reader = watcher<Note>(segment);
  EXPECT_EQ(must(reader.next(kNow))->value, 1u);
  EXPECT_EQ(must(reader.next(kNow))->value, 2u);
  EXPECT_EQ(must(reader.latest(kNow))->value, 5u);
  EXPECT_EQ(must(reader.at(290))->value, 3u);
  EXPECT_EQ(reader.next(kNow).error().code, Errc::timeout);
  EXPECT_EQ(reader.received(), 3u);
  EXPECT_EQ(reader.skipped(), 2u);
}

TEST(Watch, ChangesNothingInTheRing) {
  const auto segment = make_ring<Strip>(4, false, sizeof(Strip) + 64);
  auto writer = must(Writer<Strip>::attach(again(segment)));
  writer.publish(writer.loan());
  const auto before = words_of(segment);
  {
    auto reader = watcher<Strip>(segment);
    const auto held = must(reader.next(kNow));
    EXPECT_FALSE(reader.next(Deadline::in(5ms)));
    EXPECT_EQ(words_of(segment), before) << "while it holds a message";
  }
  EXPECT_EQ(words_of(segment), before) << "after its end";
}

TEST(Watch, ARingWithoutAFreeRowCanBeWatched) {
  const auto segment = make_ring<Note>(4);
  auto writer = must(Writer<Note>::attach(again(segment)));
  std::vector<Reader<Note>> readers;
  for (int row = 0; row < kReaderRows; ++row)
    readers.push_back(must(Reader<Note>::attach(again(segment))));
  ASSERT_FALSE(Reader<Note>::attach(again(segment)));
  writer.publish(note(7));
  EXPECT_EQ(must(watcher<Note>(segment).next(kNow))->value, 7u);
}

TEST(Watch, AMessageIsACopyThatStaysWhileTheWriterGoesOn) {
  const auto segment = make_ring<Strip>(2, false, sizeof(Strip) + 8);
  auto writer = must(Writer<Strip>::attach(again(segment)));
  const auto publish = [&](std::uint8_t value) {
    auto loan = writer.loan();
    ASSERT_TRUE(loan);
    loan->tail_length = 8;
    std::memset(loan->tail(), value, 8);
    writer.publish(std::move(loan));
  };
  publish(1);
  auto reader = watcher<Strip>(segment);
  const auto held = must(reader.next(kNow));
  EXPECT_FALSE(held.leased());
  for (std::uint8_t value = 2; value < 10; ++value) publish(value);
  EXPECT_EQ(held->tail()[7], 1);
  EXPECT_EQ(RingView(must(RingView::open(duplicate(segment.fd())))).look().dropped, 0u);
}

TEST(Watch, EveryWayToWaitSeesTheNextMessage) {
  for (const auto wait : {Wait::spin, Wait::predictive, Wait::futex, Wait::eventfd}) {
    const auto segment = make_ring<Note>(4);
    auto writer = must(Writer<Note>::attach(again(segment)));
    auto reader = watcher<Note>(segment, wait);
    std::jthread later([&] {
      for (std::uint64_t i = 1; i <= 20; ++i) {
        std::this_thread::sleep_for(3ms);
        writer.publish(note(i));
      }
    });
    for (std::uint64_t last = 0; last < 20;) {
      const auto message = reader.next(Deadline::in(20s));
      ASSERT_TRUE(message) << message.error().what;
      last = (*message)->value;
    }
  }
}

TEST(Watch, ARingOfAnotherTypeIsRefused) {
  const auto segment = make_ring<Note>(4);
  const auto reader = Reader<OtherNote>::watch(for_reading(segment));
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().code, Errc::bad_data);
}

}  // namespace
}  // namespace handcast::ipc
