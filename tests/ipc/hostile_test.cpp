// SPDX-License-Identifier: Apache-2.0
// Memory to which another program writes random words: every call must return, with a message
// inside its bounds or with an error.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <random>
#include <thread>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/ring/copy.hpp"
#include "ipc/ring/ring_view.hpp"
#include "ipc/ring/row_owner.hpp"
#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace std::chrono_literals;
using namespace handcast::ipc::samples;

constexpr std::size_t kTail = 200;

/// Random values, many of which resemble valid words.
std::uint64_t nonsense(std::mt19937_64& random) {
  const std::uint64_t any = random();
  switch (any >> 61) {
    case 0:
      return 0;
    case 1:
      return ~std::uint64_t{0};
    case 2:
      return any & 0xff;
    case 3:
      return (any & 7) << 56 | (random() & 15);  // like a head
    case 4:
      return (any & 7) << 49 | (random() & 15);  // like a state
    case 5:
      return (any & 3) << 48 | (random() & 7) << 40;  // like a lease
    default:
      return any;
  }
}

void scribble_between(std::byte* from, std::byte* to, std::mt19937_64& random, int one_word_in) {
  for (auto* at = from; at + sizeof(std::uint64_t) <= to; at += sizeof(std::uint64_t))
    if (random() % static_cast<unsigned>(one_word_in) == 0)
      store_relaxed(*reinterpret_cast<PayloadWord*>(at), nonsense(random));
}

/// Overwrites random words behind the header: head, epoch, states, rows, tallies, messages.
void scribble(const Segment& segment, std::mt19937_64& random, int one_word_in) {
  scribble_between(segment.data() + kControlOffset, segment.data() + segment.size(), random,
                   one_word_in);
}

/// Reads the whole tail, so that a sanitizer detects a read beyond a copy.
std::uint64_t sum_of_tail(const Strip& strip) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < strip.tail_length && i < kTail; ++i) sum += strip.tail()[i];
  return sum;
}

/// The size in a copy was checked and cannot change. A leased message may change while it is held.
void check(const Result<Sample<Strip>>& sample) {
  if (!sample) return;
  EXPECT_TRUE(sample->leased() || (*sample)->tail_length <= kTail);
  EXPECT_LE(sum_of_tail(**sample), 255 * kTail);
}

void use(Reader<Strip>& reader, std::mt19937_64& random) {
  const auto deadline = [&] { return random() % 16 ? Deadline::now() : Deadline::in(200us); };
  const auto first = reader.next(deadline());
  check(first);
  check(reader.latest(deadline()));
  check(reader.at(static_cast<std::int64_t>(nonsense(random))));
}

void use(Writer<Strip>& writer, std::mt19937_64& random) {
  if (auto loan = writer.loan()) {
    loan->tail_length = random() % (kTail + 1);
    if (random() % 4) writer.publish(std::move(loan));
  }
}

void look(const RingView& view) {
  const auto ring = view.look();
  EXPECT_LE(ring.readers.size(), static_cast<std::size_t>(kReaderRows));
  for (const auto& reader : ring.readers) {
    EXPECT_GE(*std::min_element(reader.lease_ages_ns.begin(), reader.lease_ages_ns.end()), -1);
    EXPECT_LE(reader.lag, kSequenceMask);
  }
  EXPECT_LE(view.sequence(), kSequenceMask);
  EXPECT_LE(view.epoch(), kEpochMask);
}

RingView view_of(const Segment& segment) { return must(RingView::open(duplicate(segment.fd()))); }

Hold any_hold(std::mt19937_64& random) { return random() % 2 ? Hold::lease : Hold::copy; }

TEST(Hostile, RandomWordsNeitherCrashNorHangAReaderAWriterAViewOrASweep) {
  const auto segment = make_ring<Strip>(5, false, sizeof(Strip) + kTail);
  const auto header = *reinterpret_cast<const SegmentHeader*>(segment.data());
  const auto view = view_of(segment);
  std::mt19937_64 random(3);
  int readers = 0;
  for (int round = 0; round < 1200; ++round) {
    scribble(segment, random, 1 + static_cast<int>(random() % 20));
    auto writer = must(Writer<Strip>::attach(again(segment)));
    look(view);
    sweep_dead_rows(segment);
    // Fails if all rows happen to look taken.
    auto reader =
        Reader<Strip>::attach(again(segment), static_cast<Wait>(random() % 3), any_hold(random));
    for (int turn = 0; turn < 10; ++turn) {
      if (turn == 5)
        // The header is not read again.
        scribble_between(segment.data(), segment.data() + kControlOffset, random, 3);
      use(writer, random);
      if (reader) use(*reader, random);
      look(view);
      scribble(segment, random, 50);
    }
    sweep_dead_rows(segment);
    readers += reader.has_value();
    std::memcpy(segment.data(), &header, sizeof header);
  }
  EXPECT_GT(readers, 300);
}

TEST(Hostile, WordsThatChangeAllTheTimeNeitherCrashNorHangAReaderAWriterAViewOrASweep) {
  const auto segment = make_ring<Strip>(3, true, sizeof(Strip) + kTail);
  auto writer = must(Writer<Strip>::attach(again(segment)));
  auto leasing = must(Reader<Strip>::attach(again(segment), Wait::futex, Hold::lease));
  auto copying = must(Reader<Strip>::attach(again(segment), Wait::predictive, Hold::copy));
  auto bridged = must(Reader<Strip>::attach(again(segment), Wait::eventfd, Hold::lease));
  const auto view = view_of(segment);
  std::atomic<bool> stop{false};
  std::jthread enemy([&, mapped = again(segment)] {
    std::mt19937_64 random(5);
    while (!stop) scribble(mapped, random, 10);
  });
  std::mt19937_64 random(7);
  for (int turn = 0; turn < 8000; ++turn) {
    use(writer, random);
    for (auto* reader : {&leasing, &copying, &bridged}) use(*reader, random);
    look(view);
    if (turn % 16 == 0) sweep_dead_rows(segment);
  }
  stop = true;
}

template <class Message>
void expect_no_size_to_wrap(std::uint32_t Message::*width, std::uint32_t Message::*height) {
  auto message = std::make_unique<Message>();
  for (const std::uint32_t w : {0u, 1u, 3u, 1u << 16, 1u << 30, 1u << 31, ~0u})
    for (const std::uint32_t h : {0u, 1u, 3u, 1u << 16, 1u << 30, 1u << 31, ~0u}) {
      (*message).*width = w;
      (*message).*height = h;
      // A lower bound, with one byte per pixel.
      const auto exact =
          static_cast<long double>(sizeof(Message)) + static_cast<long double>(w) * h;
      EXPECT_GE(static_cast<long double>(message->used_bytes()),
                std::min(exact, static_cast<long double>(~std::size_t{0})))
          << w << " x " << h;
    }
}

TEST(Hostile, NoSizeOfAPictureWrapsAround) {
  expect_no_size_to_wrap(&msg::CameraFrame::width_px, &msg::CameraFrame::height_px);
  expect_no_size_to_wrap(&msg::Projection::region_width_px, &msg::Projection::region_height_px);
  EXPECT_EQ(msg::Projection::bytes(1u << 31, 1u << 31), ~std::size_t{0});
  EXPECT_EQ(msg::CameraFrame::bytes(~std::size_t{0}, 2), ~std::size_t{0});
  EXPECT_EQ(msg::Projection::bytes(3, 5), sizeof(msg::Projection) + 60 + 2 * 6)
      << "15 pixels and room for 1 x 2 shown points";
}

TEST(Hostile, APictureLargerThanItsSlotIsBadDataHoweverLarge) {
  const auto segment = must(Segment::create(
      RingSpec::of<msg::Projection>("test.ring", 3, false, msg::Projection::bytes(4, 4))));
  auto writer = must(Writer<msg::Projection>::attach(again(segment)));
  auto reader = must(Reader<msg::Projection>::attach(again(segment)));
  for (const auto& [width, height] : {std::pair{4u, 5u}, std::pair{1u << 31, 1u << 31},
                                      std::pair{1u << 31, 1u << 30}, std::pair{~0u, ~0u}}) {
    auto loan = writer.loan();
    loan->region_width_px = width;
    loan->region_height_px = height;
    writer.publish(std::move(loan));
    EXPECT_EQ(reader.next(kNow).error().code, Errc::bad_data) << width << " x " << height;
  }
}

TEST(Hostile, AHeadBeyondTheSlotsIsBadData) {
  const auto segment = make_ring<Note>(4);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  writer.publish(note(1));
  const auto words = control_words_of(segment);
  RealAtomics::store(words.head(), head_word(4, 2), std::memory_order_seq_cst);
  EXPECT_EQ(reader.latest(Deadline::in(1s)).error().code, Errc::bad_data);
  writer.publish(note(2));
  EXPECT_EQ(must(reader.latest(kNow))->value, 2u);
}

TEST(Hostile, AHeadThatGoesBackIsReportedOnceThenFollowed) {
  const auto segment = make_ring<Note>(4);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = must(Reader<Note>::attach(again(segment)));
  for (std::uint64_t i = 1; i <= 5; ++i) writer.publish(note(i));
  ASSERT_TRUE(reader.latest(kNow));
  RealAtomics::store(control_words_of(segment).head(), head_word(0, 2), std::memory_order_seq_cst);
  EXPECT_EQ(reader.latest(kNow).error().code, Errc::bad_data);
  EXPECT_EQ(reader.latest(kNow).error().code, Errc::timeout);
  writer.publish(note(6));
  EXPECT_EQ(must(reader.latest(kNow))->value, 6u);
}

TEST(Hostile, AWriterFindsItsWayPastTheLastSequence) {
  const auto segment = make_ring<Note>(4);
  const auto words = control_words_of(segment);
  RealAtomics::store(words.head(), head_word(0, kSequenceMask), std::memory_order_seq_cst);
  RealAtomics::store(words.state(0), state_word(kEpochMask, kSequenceMask),
                     std::memory_order_seq_cst);
  auto writer = must(Writer<Note>::attach(again(segment)));
  writer.publish(note(1));
  auto reader = must(Reader<Note>::attach(again(segment)));
  const auto sample = must(reader.latest(kNow));
  EXPECT_EQ(sample->value, 1u);
  EXPECT_EQ(sample.sequence(), 1u);
}

}  // namespace
}  // namespace handcast::ipc
