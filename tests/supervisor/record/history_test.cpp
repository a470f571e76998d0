// SPDX-License-Identifier: Apache-2.0
#include "supervisor/record/history.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <malloc.h>
#include <sys/mman.h>

#include <random>

#include "supervisor/record/history_layout.hpp"
#include "tests/supervisor/record/marked_frames.hpp"

namespace handcast::supervisor {
namespace {

using msg::Stage;
using test::everything_in, test::frame, test::mark, test::kSecond_ns, test::kStart_ns;
using testing::ElementsAre;
using testing::HasSubstr;

/// `seconds` of the frames of a projector, `hz` of them a second.
void fill(History& history, double seconds, double hz = 1000, double from_s = 0) {
  for (int i = 0; i < seconds * hz; ++i) {
    const double ms = from_s * 1e3 + i * 1e3 / hz;
    history.add("projector",
                frame(static_cast<std::uint64_t>(i), ms - 3,
                      {mark(Stage::predict, ms, ms + 0.1), mark(Stage::draw, ms + 0.1, ms + 0.5),
                       mark(Stage::frame, ms, ms + 0.6)}),
                0);
  }
}

UniqueFd file_of(std::span<const std::byte> bytes) {
  UniqueFd file(memfd_create("test", MFD_CLOEXEC));
  EXPECT_EQ(::write(file.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  return file;
}

std::vector<std::byte> bytes_of(const UniqueFd& file) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(::lseek(file.get(), 0, SEEK_END)));
  EXPECT_EQ(::pread(file.get(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  return bytes;
}

TEST(History, GivesBackWhatItWasTold) {
  History history(60);
  history.add("camera", frame(7, 1, {mark(Stage::capture, 1, 4)}), 0);
  history.add("projector", frame(7, 1, {mark(Stage::draw, 5, 6), mark(Stage::frame, 5, 7)}), 3);
  const auto seen = everything_in(history);
  EXPECT_THAT(seen.services, ElementsAre("camera", "projector"));
  EXPECT_EQ(seen.supervisor, getpid());
  ASSERT_EQ(seen.frames.size(), 2u);
  EXPECT_EQ(seen.frames[0].service, 0u);
  EXPECT_EQ(seen.frames[0].marks.size(), 1u);
  EXPECT_EQ(seen.frames[1].service, 1u);
  EXPECT_EQ(seen.frames[1].missed, 3u);
  EXPECT_EQ(seen.frames[1].header.frame_id, 7u);
  EXPECT_EQ(seen.frames[1].header.origin_ns, kStart_ns + 1'000'000);
  ASSERT_EQ(seen.frames[1].marks.size(), 2u);
  EXPECT_EQ(seen.frames[1].marks[1].stage, Stage::frame);
  EXPECT_EQ(seen.frames[1].marks[1].end_ns - seen.frames[1].marks[1].begin_ns, 2'000'000);
}

TEST(History, AHeartBeatIsNotKeptButWhatWasMissedBeforeItIs) {
  History history(60);
  history.add("camera", frame(0, 1, {}), 4);
  EXPECT_TRUE(everything_in(history).frames.empty());
  history.add("camera", frame(0, 1, {mark(Stage::capture, 1, 2)}), 1);
  EXPECT_EQ(everything_in(history).frames[0].missed, 5u);
}

TEST(History, ForgetsWhatIsOlderThanItsSpan) {
  History history(2);
  fill(history, 10);
  const auto seen = everything_in(history);
  EXPECT_NEAR(static_cast<double>(seen.frames.size()), 2000, 2);
  EXPECT_GE(seen.frames.front().header.published_ns, kStart_ns + 8 * kSecond_ns - 2'000'000);
}

TEST(History, ReachesAsFarBackAsItWasLastTold) {
  History history(60);
  fill(history, 10);
  history.set_span(2);
  EXPECT_NEAR(static_cast<double>(everything_in(history).frames.size()), 2000, 2);
}

TEST(History, ASnapshotBeginsWhenItIsAskedTo) {
  History history(60);
  fill(history, 10);
  const auto recent = read_history(history.snapshot(kStart_ns + 7 * kSecond_ns).value());
  ASSERT_TRUE(recent);
  EXPECT_NEAR(static_cast<double>(recent->frames.size()), 3000, 2);
  EXPECT_EQ(read_history(history.snapshot(kStart_ns + 20 * kSecond_ns).value())->frames.size(), 0u);
}

TEST(History, NeedsNoMoreMemoryThanItsSpanAsksFor) {
  History history(2);
  fill(history, 4);
  const auto settled = history.bytes();
  fill(history, 20, 1000, 4);
  EXPECT_LE(history.bytes(), settled);
  EXPECT_LE(settled, 4 * History::kBlockBytes) << "2 s of 1000 frames with 112 bytes each";
}

TEST(History, IsBoundedInBytesWhateverASpanAsksFor) {
  History history(3600);
  const auto busy = frame(1, 0,
                          {mark(Stage::draw, 1, 2), mark(Stage::warp, 2, 3),
                           mark(Stage::fill, 3, 4), mark(Stage::frame, 1, 4)});
  for (int i = 0; i < 700'000; ++i) history.add("projector", busy, 0);
  EXPECT_EQ(history.bytes(), History::kMostBlocks * History::kBlockBytes);
  const auto kept = everything_in(history).frames.size();
  EXPECT_GT(kept * (sizeof(FrameHead) + 4 * sizeof(msg::StageMark)), 60u << 20);
}

#if !defined(HANDCAST_WITH_SANITIZER)
TEST(History, AllocatesNothingOnceItIsAsLongAsItGets) {
  History history(1);
  fill(history, 3);
  const auto in_use = [] { return mallinfo2().uordblks + mallinfo2().hblkhd; };
  const auto before = in_use();
  fill(history, 10, 1000, 3);
  EXPECT_EQ(in_use(), before);
}
#endif

TEST(History, MarksThatMakeNoSenseAreLeftOut) {
  History history(60);
  auto wild = frame(1, 0, {mark(Stage::draw, 1, 2)});
  wild.count = 4'000'000'000u;
  for (std::size_t i = 1; i < wild.marks.size(); ++i)
    wild.marks[i] = {static_cast<Stage>(77), 0, 5, 9};
  wild.marks[1] = {Stage::fill, 0, 9, 5};
  wild.marks[2] = {Stage::fill, 0, std::numeric_limits<std::int64_t>::min(),
                   std::numeric_limits<std::int64_t>::max()};
  history.add("projector", wild, 0);
  const auto seen = everything_in(history);
  ASSERT_EQ(seen.frames.size(), 1u);
  EXPECT_EQ(seen.frames[0].marks.size(), 1u);
}

TEST(History, ASnapshotCannotBeChangedByWhoeverHoldsIt) {
  History history(60);
  fill(history, 1);
  const auto file = history.snapshot(0).value();
  const std::byte one{1};
  EXPECT_EQ(::pwrite(file.get(), &one, 1, 0), -1);
  EXPECT_EQ(::ftruncate(file.get(), 1), -1);
  EXPECT_EQ(fcntl(file.get(), F_ADD_SEALS, F_SEAL_FUTURE_WRITE), -1);
}

TEST(HistoryFile, CutAnywhereIsAnErrorAndNotACrash) {
  History history(60);
  fill(history, 0.02);
  const auto whole = bytes_of(history.snapshot(0).value());
  for (std::size_t size = 0; size < whole.size(); size += 5) {
    const auto read = read_history(file_of(std::span(whole).first(size)));
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(read.error().code, Errc::bad_data);
  }
  auto longer = whole;
  longer.resize(whole.size() + 8);
  EXPECT_FALSE(read_history(file_of(longer)));
}

TEST(HistoryFile, RandomBytesAnywhereAreAnErrorOrFramesThatMakeSense) {
  History history(60);
  fill(history, 0.05);
  const auto whole = bytes_of(history.snapshot(0).value());
  std::mt19937 random(7);
  for (int trial = 0; trial < 3000; ++trial) {
    auto hurt = whole;
    for (int i = 0; i < 4; ++i) hurt[random() % hurt.size()] = static_cast<std::byte>(random());
    const auto read = read_history(file_of(hurt));
    if (!read) continue;
    for (const auto& each : read->frames) {
      ASSERT_LT(each.service, read->services.size());
      for (const auto& one : each.marks) ASSERT_TRUE(makes_sense(one));
    }
  }
}

TEST(HistoryFile, WhatIsNoFileIsNamed) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  const UniqueFd read_end(ends[0]), write_end(ends[1]);
  EXPECT_THAT(read_history(read_end).error().what, HasSubstr("not a file"));
  EXPECT_FALSE(read_history(UniqueFd()));
}

}  // namespace
}  // namespace handcast::supervisor
