// Memory that somebody else writes nonsense to: every call comes back, with a message that keeps to its bounds or an error.
#include <atomic>
#include <random>
#include <thread>

#include "ipc/ring/copy.hpp"
#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace std::chrono_literals;
using namespace handcast::ipc::testing;

constexpr std::size_t kTail = 200;

/// Values of which many come close to meaning something.
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

void scribble(const Segment& segment, std::mt19937_64& random, int one_word_in) {
  const auto end = segment.data() + segment.size();
  for (auto* at = segment.data() + kControlOffset; at + sizeof(std::uint64_t) <= end; at += sizeof(std::uint64_t))
    if (random() % static_cast<unsigned>(one_word_in) == 0) store_relaxed(*reinterpret_cast<PayloadWord*>(at), nonsense(random));
}

void use(Reader<Strip>& reader, Writer<Strip>& writer, std::mt19937_64& random) {
  const auto check = [](const Result<Sample<Strip>>& sample) {
    if (!sample) return;
    EXPECT_LE((*sample)->tail_length, kTail);
    std::uint64_t sum = 0;  // a sanitizer would see a read beyond the copy
    for (std::size_t i = 0; i < (*sample)->tail_length && i < kTail; ++i) sum += (*sample)->tail()[i];
    EXPECT_LE(sum, 255 * kTail);
  };
  const auto deadline = [&] { return random() % 16 ? Deadline::now() : Deadline::in(200us); };
  check(reader.next(deadline()));
  check(reader.latest(deadline()));
  check(reader.at(static_cast<std::int64_t>(nonsense(random))));
  if (auto loan = writer.loan()) {
    loan->tail_length = random() % (kTail + 1);
    if (random() % 4) writer.publish(std::move(loan));
  }
}

TEST(Hostile, RandomWordsNeitherCrashNorHangAReaderOrAWriter) {
  const auto segment = make_ring<Strip>(5, false, sizeof(Strip) + kTail);
  std::mt19937_64 random(3);
  for (int round = 0; round < 400; ++round) {
    scribble(segment, random, 1 + static_cast<int>(random() % 20));
    auto writer = must(Writer<Strip>::attach(again(segment)));
    auto reader = Reader<Strip>::attach(again(segment), static_cast<Wait>(random() % 3));
    if (!reader) continue;  // every row may look taken
    for (int turn = 0; turn < 10; ++turn) {
      use(*reader, writer, random);
      scribble(segment, random, 50);
    }
  }
}

TEST(Hostile, WordsThatChangeAllTheTimeNeitherCrashNorHangAReaderOrAWriter) {
  const auto segment = make_ring<Strip>(3, true, sizeof(Strip) + kTail);
  auto writer = must(Writer<Strip>::attach(again(segment)));
  auto reader = must(Reader<Strip>::attach(again(segment)));
  std::atomic<bool> stop{false};
  std::jthread enemy([&, mapped = again(segment)] {
    std::mt19937_64 random(5);
    while (!stop) scribble(mapped, random, 10);
  });
  std::mt19937_64 random(7);
  for (int turn = 0; turn < 5000; ++turn) use(reader, writer, random);
  stop = true;
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
  RealAtomics::store(words.state(0), state_word(kEpochMask, kSequenceMask), std::memory_order_seq_cst);
  auto writer = must(Writer<Note>::attach(again(segment)));
  writer.publish(note(1));
  auto reader = must(Reader<Note>::attach(again(segment)));
  const auto sample = must(reader.latest(kNow));
  EXPECT_EQ(sample->value, 1u);
  EXPECT_EQ(sample.sequence(), 1u);
}

}  // namespace
}  // namespace handcast::ipc
