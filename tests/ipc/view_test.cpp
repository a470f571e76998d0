// SPDX-License-Identifier: Apache-2.0
// Tests of the read-only view of a ring.
#include <gmock/gmock.h>

#include "ipc/ring/ring_view.hpp"
#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace handcast::ipc::samples;

RingView view_of(const Segment& segment) { return must(RingView::open(duplicate(segment.fd()))); }

TEST(View, AnEmptyRingHasNothingToShow) {
  const auto segment = must(Segment::create(RingSpec::of<Note>("camera.frames", 5, false)));
  const auto view = view_of(segment);
  const auto ring = view.look();
  EXPECT_EQ(ring.stream, "camera.frames");
  EXPECT_EQ(ring.slots, 5);
  EXPECT_EQ(ring.epoch + ring.sequence + ring.published + ring.dropped, 0u);
  EXPECT_TRUE(ring.readers.empty());
  EXPECT_EQ(view.epoch() + view.sequence(), 0u);
}

TEST(View, ShowsTheNewestMessageAndWhoseItIs) {
  const auto segment = make_ring<Note>(4);
  const auto view = view_of(segment);
  auto writer = std::make_unique<Writer<Note>>(must(Writer<Note>::attach(again(segment))));
  EXPECT_EQ(view.look().epoch, 1u);
  EXPECT_EQ(view.epoch(), 0u) << "the writer has published nothing yet";
  const auto before_ns = now_ns();
  writer->publish(note(1, 4711));
  writer->publish(note(2, 4712));
  const auto ring = view.look();
  EXPECT_EQ(ring.sequence, 2u);
  EXPECT_EQ(ring.newest_origin_ns, 4712);
  EXPECT_GE(ring.newest_published_ns, before_ns);
  EXPECT_EQ(view.epoch(), 1u);
  writer.reset();
  writer = std::make_unique<Writer<Note>>(must(Writer<Note>::attach(again(segment))));
  EXPECT_EQ(view.epoch(), 1u) << "the newest message is still that of the previous writer";
  EXPECT_EQ(view.look().epoch, 2u);
  writer->publish(note(3));
  EXPECT_EQ(view.epoch(), 2u);
  EXPECT_EQ(view.sequence(), 3u);
}

TEST(View, ShowsHowFarEachReaderIs) {
  const auto segment = make_ring<Note>(4, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto ahead = must(Reader<Note>::attach(again(segment)));
  auto behind = must(Reader<Note>::attach(again(segment)));
  const auto origin_ns = now_ns() - 5'000'000;
  for (std::uint64_t i = 1; i <= 10; ++i) writer.publish(note(i, origin_ns));
  while (ahead.next(kNow)) continue;  // 7 to 10 are still there
  const auto readers = view_of(segment).look().readers;
  ASSERT_EQ(readers.size(), 2u);
  EXPECT_EQ(readers[0].row, 0);
  EXPECT_EQ(readers[0].pid, ::getpid());
  EXPECT_EQ(readers[0].received, 4u);
  EXPECT_EQ(readers[0].skipped, 6u);
  EXPECT_EQ(readers[0].lag, 0u);
  EXPECT_GE(readers[0].age_ns, 5'000'000);
  EXPECT_LE(readers[0].age_ns, now_ns() - origin_ns);
  EXPECT_EQ(readers[1].received, 0u);
  EXPECT_EQ(readers[1].lag, 10u);
  EXPECT_FALSE(readers[1].waiting);
}

TEST(View, ShowsWhatIsUnusableWhatIsCopiedForWantOfALeaseAndHowOldLeasesAre) {
  const auto segment = make_ring<Strip>(6, false, sizeof(Strip) + 10);
  auto writer = must(Writer<Strip>::attach(again(segment)));
  auto reader = must(Reader<Strip>::attach(again(segment)));
  const auto view = view_of(segment);
  std::vector<Sample<Strip>> held;
  for (int i = 0; i < 3; ++i) {
    writer.publish(writer.loan());
    held.push_back(must(reader.next(kNow)));
  }
  auto loan = writer.loan();
  loan->tail_length = 11;
  writer.publish(std::move(loan));
  EXPECT_FALSE(reader.next(kNow));
  auto shown = view.look().readers.at(0);
  EXPECT_EQ(shown.copied, 2u) << "the unusable message was copied, too";
  EXPECT_EQ(shown.unusable, 1u);
  EXPECT_EQ(shown.received, 3u);
  EXPECT_GE(shown.lease_ages_ns[1], 0);
  EXPECT_GT(shown.lease_ages_ns[0], shown.lease_ages_ns[1]);
  EXPECT_LE(shown.lease_ages_ns[0], now_ns() - held[0]->header.published_ns);
  held.erase(held.begin());
  shown = view.look().readers.at(0);
  EXPECT_EQ(shown.lease_ages_ns[0], -1);
  EXPECT_GE(shown.lease_ages_ns[1], 0);
}

TEST(View, AWritersCountsGoOnWithTheNextWriterAndARowsBeginAnew) {
  const auto segment = make_ring<Note>(2);
  const auto view = view_of(segment);
  for (std::uint64_t life = 1; life <= 3; ++life) {
    auto writer = must(Writer<Note>::attach(again(segment)));
    auto reader = must(Reader<Note>::attach(again(segment)));
    EXPECT_EQ(view.look().readers.at(0).received, 0u);
    EXPECT_EQ(view.look().readers.at(0).age_ns, 0);
    for (std::uint64_t i = 0; i < 5; ++i) writer.publish(note(i));
    const auto loan = writer.loan();
    EXPECT_FALSE(writer.loan());
    EXPECT_EQ(view.look().published, 5 * life);
    EXPECT_EQ(view.look().dropped, life);
    EXPECT_EQ(writer.published(), 5u);
    EXPECT_TRUE(reader.latest(kNow));
    EXPECT_EQ(view.look().readers.at(0).received, 1u);
  }
}

TEST(View, ShowsHowLongTheStreamPausedBetweenTwoWriters) {
  const auto segment = make_ring<Note>(4);
  const auto view = view_of(segment);
  std::int64_t last_ns = 0;
  for (int life = 0; life < 3; ++life) {
    auto writer = must(Writer<Note>::attach(again(segment)));
    EXPECT_EQ(view.look().newest_published_ns, last_ns);
    writer.publish(note(1));
    const auto first = view.look();
    EXPECT_EQ(first.pause_ns, life == 0 ? 0 : first.newest_published_ns - last_ns);
    sleep_until_ns(now_ns() + 2'000'000);
    writer.publish(note(2));
    EXPECT_EQ(view.look().pause_ns, first.pause_ns) << "later messages do not change it";
    last_ns = view.look().newest_published_ns;
  }
}

TEST(View, NeedsOnlyADescriptorForReadingAndTakesNoRow) {
  const auto segment = make_ring<Note>(4);
  must(Writer<Note>::attach(again(segment))).publish(note(1));
  const auto view = must(RingView::open(UniqueFd(
      ::open(("/proc/self/fd/" + std::to_string(segment.fd())).c_str(), O_RDONLY | O_CLOEXEC))));
  EXPECT_EQ(view.look().sequence, 1u);
  EXPECT_TRUE(view.look().readers.empty());
  EXPECT_EQ(RingView::open(UniqueFd(::open("/dev/null", O_RDONLY | O_CLOEXEC))).error().code,
            Errc::bad_data);
}

}  // namespace
}  // namespace handcast::ipc
