// SPDX-License-Identifier: Apache-2.0
// Messages that are read in their slots.
#include <gmock/gmock.h>

#include <cstdlib>
#include <new>
#include <thread>

#include "tests/ipc/ring_testing.hpp"

namespace {
std::atomic<std::uint64_t> allocations{0};
}
// Replaced to count the allocations of this program.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace handcast::ipc {
namespace {

using namespace std::chrono_literals;
using namespace handcast::ipc::samples;
using ::testing::HasSubstr;

constexpr std::size_t kTail = 100;

struct Strips {
  explicit Strips(int slots, bool keep_history = false)
      : segment(make_ring<Strip>(slots, keep_history, sizeof(Strip) + kTail)) {}

  Writer<Strip> writer() const { return must(Writer<Strip>::attach(again(segment))); }
  Reader<Strip> reader(Hold hold = Hold::lease) const {
    return must(Reader<Strip>::attach(again(segment), Wait::futex, hold));
  }
  ControlWords<RealAtomics> words() const { return control_words_of(segment); }
  std::uint64_t lease_word_of(int row, int index) const {
    return RealAtomics::load(words().lease(row, index), std::memory_order_seq_cst);
  }
  int leases_out() const {
    int out = 0;
    for (int row = 0; row < kReaderRows; ++row)
      for (int index = 0; index < kLeasesPerRow; ++index)
        out += is_leased(lease_word_of(row, index));
    return out;
  }

  Segment segment;
};

void publish(Writer<Strip>& writer, std::uint8_t value) {
  auto loan = writer.loan();
  if (!loan) return;
  loan->header.origin_ns = value;
  loan->tail_length = kTail;
  std::fill_n(loan->tail(), kTail, value);
  writer.publish(std::move(loan));
}

bool says(const Sample<Strip>& sample, std::uint8_t value) {
  return sample->tail_length == kTail && std::all_of(sample->tail(), sample->tail() + kTail,
                                                     [=](auto byte) { return byte == value; });
}

TEST(Lease, AMessageWithATailIsReadWhereItLiesAndASmallOneIsCopied) {
  const Strips ring(4);
  auto writer = ring.writer();
  auto reader = ring.reader();
  publish(writer, 1);
  const auto sample = must(reader.next(kNow));
  EXPECT_TRUE(sample.leased());
  EXPECT_TRUE(says(sample, 1));
  reinterpret_cast<Strip*>(ring.segment.slot_at(slot_of_lease(ring.lease_word_of(0, 0))))
      ->tail()[7] = 99;
  EXPECT_EQ(sample->tail()[7], 99) << "the sample must be the slot itself";

  const auto notes = make_ring<Note>(4);
  must(Writer<Note>::attach(again(notes))).publish(note(1));
  EXPECT_FALSE(must(must(Reader<Note>::attach(again(notes))).next(kNow)).leased());
}

TEST(Lease, TheWriterGoesOnAroundALeasedMessageAndLeavesItAlone) {
  for (const bool keep_history : {false, true}) {
    const Strips ring(4, keep_history);
    auto writer = ring.writer();
    auto reader = ring.reader();
    publish(writer, 1);
    const auto first = must(reader.next(kNow));
    publish(writer, 2);
    const auto second = must(reader.next(kNow));
    for (std::uint8_t value = 3; value < 100; ++value) publish(writer, value);
    EXPECT_TRUE(says(first, 1));
    EXPECT_TRUE(says(second, 2));
    EXPECT_EQ(writer.published(), 99u);
    EXPECT_EQ(writer.dropped(), 0u);
  }
}

TEST(Lease, WithBothLeasesOutTheNextMessageIsACopyAndAReleasedLeaseIsUsedAgain) {
  const Strips ring(6);
  auto writer = ring.writer();
  auto reader = ring.reader();
  std::vector<Sample<Strip>> held;
  for (std::uint8_t value = 1; value <= 4; ++value) {
    publish(writer, value);
    held.push_back(must(reader.next(kNow)));
    EXPECT_EQ(held.back().leased(), value <= kLeasesPerRow);
  }
  EXPECT_EQ(reader.copied(), 2u);
  for (std::uint8_t value = 5; value < 50; ++value) publish(writer, value);
  for (std::uint8_t value = 1; value <= 4; ++value) EXPECT_TRUE(says(held[value - 1u], value));
  held.clear();
  EXPECT_TRUE(must(reader.latest(kNow)).leased());
  EXPECT_EQ(reader.copied(), 2u);
  EXPECT_EQ(reader.received(), 5u);
}

TEST(Lease, WhoAsksForCopiesGetsCopiesAndLeasesNothing) {
  const Strips ring(4);
  auto writer = ring.writer();
  auto reader = ring.reader(Hold::copy);
  publish(writer, 1);
  const auto sample = must(reader.next(kNow));
  EXPECT_FALSE(sample.leased());
  EXPECT_TRUE(says(sample, 1));
  EXPECT_EQ(ring.leases_out(), 0);
  EXPECT_EQ(reader.copied(), 0u) << "only messages that should have been leased count";
}

TEST(Lease, TheWriterDropsItsOwnMessageWhileAllSlotsAreHeldAndGoesOnWhenOneIsFree) {
  const Strips ring(2);
  auto writer = ring.writer();
  auto reader = ring.reader();
  publish(writer, 1);
  auto first = must(reader.next(kNow));
  publish(writer, 2);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(writer.loan());
  EXPECT_EQ(writer.dropped(), 3u);
  first = must(reader.next(kNow));  // releases the first message
  EXPECT_TRUE(says(first, 2));
  EXPECT_TRUE(writer.loan());
}

TEST(Lease, WithTwoSlotsMoreThanLeasesALoanNeverFails) {
  constexpr int kReaders = 3;
  const Strips ring(kReaders * kLeasesPerRow + 2);
  auto writer = ring.writer();
  std::vector<Reader<Strip>> readers;
  for (int i = 0; i < kReaders; ++i) readers.push_back(ring.reader());
  std::vector<Sample<Strip>> held;
  for (std::uint8_t value = 1; value <= 2 * kReaders; ++value) {
    publish(writer, value);
    held.push_back(must(readers[value % kReaders].latest(kNow)));
  }
  EXPECT_EQ(ring.leases_out(), kReaders * kLeasesPerRow);
  for (std::uint8_t value = 10; value < 60; ++value) publish(writer, value);
  EXPECT_EQ(writer.dropped(), 0u);
}

TEST(Lease, AtAndLatestLeaseTooAndOneMessageMayBeHeldTwice) {
  const Strips ring(5, true);
  auto writer = ring.writer();
  auto reader = ring.reader();
  for (std::uint8_t value = 1; value <= 4; ++value) publish(writer, value);
  const auto newest = must(reader.latest(kNow));
  const auto same = must(reader.at(4));
  EXPECT_TRUE(newest.leased() && same.leased());
  EXPECT_EQ(&*newest, &*same);
  EXPECT_EQ(ring.leases_out(), 2);
  const auto older = must(reader.at(2));
  EXPECT_FALSE(older.leased());
  EXPECT_TRUE(says(older, 2));
}

TEST(Lease, ASampleOutlivesItsReaderAndItsWriterAndTheRowIsGivenBackAfterIt) {
  const Strips ring(4);
  auto writer = std::make_unique<Writer<Strip>>(ring.writer());
  auto reader = std::make_unique<Reader<Strip>>(ring.reader());
  publish(*writer, 1);
  auto sample = std::make_unique<Sample<Strip>>(must(reader->next(kNow)));
  reader.reset();
  for (std::uint8_t value = 2; value < 20; ++value) publish(*writer, value);
  writer.reset();
  EXPECT_TRUE(says(*sample, 1));
  EXPECT_EQ(ring.leases_out(), 1);
  EXPECT_NE(pid_of_owner(RealAtomics::load(ring.words().owner(0), std::memory_order_seq_cst)), 0u);
  sample.reset();
  EXPECT_EQ(ring.leases_out(), 0);
  EXPECT_EQ(pid_of_owner(RealAtomics::load(ring.words().owner(0), std::memory_order_seq_cst)), 0u);
}

TEST(Lease, ASampleMayDieOnAnotherThread) {
  const Strips ring(8);
  auto writer = ring.writer();
  auto reader = ring.reader();
  std::vector<std::jthread> threads;
  for (std::uint8_t value = 1; value <= 200; ++value) {
    publish(writer, value);
    threads.emplace_back(
        [value, sample = must(reader.next(kNow))] { EXPECT_TRUE(says(sample, value)); });
  }
  threads.clear();
  EXPECT_EQ(ring.leases_out(), 0);
  EXPECT_EQ(reader.revoked(), 0u);
}

TEST(Lease, MovingASampleEndsEachLeaseOnce) {
  const Strips ring(4);
  auto writer = ring.writer();
  auto reader = ring.reader();
  publish(writer, 1);
  auto first = must(reader.next(kNow));
  publish(writer, 2);
  auto second = must(reader.next(kNow));
  EXPECT_EQ(ring.leases_out(), 2);
  first = std::move(second);
  EXPECT_EQ(ring.leases_out(), 1);
  auto third = std::move(first);
  EXPECT_EQ(ring.leases_out(), 1);
  EXPECT_TRUE(says(third, 2));
  EXPECT_EQ(reader.revoked(), 0u);
}

TEST(Lease, AMessageOfImpossibleSizeIsBadDataAndItsLeaseEnds) {
  const Strips ring(4);
  auto writer = ring.writer();
  auto reader = ring.reader();
  for (const auto claim : {kTail + 1, std::size_t{1} << 40, ~std::size_t{0}}) {
    auto loan = writer.loan();
    loan->tail_length = claim;
    writer.publish(std::move(loan));
    EXPECT_EQ(reader.at(0).error().code, Errc::bad_data);
    EXPECT_EQ(reader.next(kNow).error().code, Errc::bad_data);
    EXPECT_EQ(ring.leases_out(), 0);
  }
  EXPECT_EQ(reader.skipped(), 3u);
}

TEST(Lease, ALeaseThatWasTakenAwayIsToldOnceAndCountedAndTheReaderGoesOnWithCopies) {
  const Strips ring(6);
  auto writer = ring.writer();
  auto reader = ring.reader();
  publish(writer, 1);
  auto first = std::make_unique<Sample<Strip>>(must(reader.next(kNow)));
  publish(writer, 2);
  auto second = std::make_unique<Sample<Strip>>(must(reader.next(kNow)));
  const auto owner = RealAtomics::load(ring.words().owner(0), std::memory_order_seq_cst);
  // As if another process had mistaken this one for dead.
  ASSERT_TRUE(claim_row(ring.words(), 0, owner, free_word(generation_of(owner) + 1)));
  EXPECT_EQ(ring.leases_out(), 0);
  ::testing::internal::CaptureStderr();
  first.reset();
  second.reset();
  const auto log = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(log, HasSubstr("was taken away while it was read"));
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1);
  EXPECT_EQ(reader.revoked(), 2u);
  publish(writer, 3);
  const auto third = must(reader.next(kNow));
  EXPECT_FALSE(third.leased());
  EXPECT_TRUE(says(third, 3));
}

TEST(Lease, WhoWritesToAMessageItReadsDies) {
  const Strips ring(4);
  auto writer = ring.writer();
  auto reader = ring.reader();
  publish(writer, 1);
  const auto sample = must(reader.next(kNow));
  EXPECT_DEATH(const_cast<Strip&>(*sample).tail()[0] = 2, "");
}

TEST(Lease, NothingIsAllocatedPerMessage) {
  const Strips ring(6);
  auto writer = ring.writer();
  auto leasing = ring.reader();
  auto copying = ring.reader(Hold::copy);
  const auto turn = [&](std::uint8_t value) {
    publish(writer, value);
    const auto leased = leasing.next(kNow), copied = copying.next(kNow);
    EXPECT_TRUE(leased && copied && leased->leased() && !copied->leased());
  };
  turn(0);
  const auto before = allocations.load();
  for (int i = 0; i < 100; ++i) turn(static_cast<std::uint8_t>(i));
  EXPECT_EQ(allocations.load(), before);
}

}  // namespace
}  // namespace handcast::ipc
