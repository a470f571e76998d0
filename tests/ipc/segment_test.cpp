// SPDX-License-Identifier: Apache-2.0
#include "ipc/shm/segment.hpp"

#include <gmock/gmock.h>
#include <sys/mman.h>

#include "ipc/ring/tally.hpp"
#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using ::testing::HasSubstr;
using namespace handcast::ipc::samples;

SegmentHeader& header_of(const Segment& segment) {
  return *reinterpret_cast<SegmentHeader*>(segment.data());
}

/// The reason why the ring cannot be opened; empty if it can.
std::string refusal(int fd) {
  const auto segment = Segment::open(duplicate(fd));
  if (segment) return "";
  EXPECT_EQ(segment.error().code, Errc::bad_data);
  return segment.error().what;
}

TEST(Segment, IsOpenedWithWhatItWasMadeFor) {
  const auto made = must(Segment::create(RingSpec::of<Note>("camera.frames", 5, true, 1000)));
  const auto opened = again(made);
  EXPECT_EQ(opened.stream(), "camera.frames");
  EXPECT_EQ(opened.type_hash(), msg::type_hash<Note>());
  EXPECT_EQ(opened.payload_bytes(), 1000u);
  EXPECT_EQ(opened.slots(), 5);
  EXPECT_TRUE(opened.keep_history());
  EXPECT_LE(opened.created_ns(), now_ns());
  EXPECT_GT(opened.created_ns(), 0);
  EXPECT_NE(opened.data(), made.data());
}

TEST(Segment, EveryWriterHasLinesOfItsOwnAndAllLieWithinTheMemory) {
  const auto segment = make_ring<Note>(kMaxSlots);
  const auto words = control_words_of(segment);
  const auto offset = [&](const auto& word) {
    return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&word) - segment.data());
  };
  std::vector<std::size_t> lines{offset(words.head()), offset(words.epoch())};
  for (int slot = 0; slot < words.slots(); ++slot) lines.push_back(offset(words.state(slot)));
  for (int row = 0; row < kReaderRows; ++row) {
    lines.push_back(offset(words.owner(row)));
    for (const auto* word : {&words.wait(row), &words.lease(row, 0), &words.lease(row, 1)})
      EXPECT_EQ(offset(*word) / kLineBytes, lines.back() / kLineBytes)
          << "the words of a row belong to one reader";
    EXPECT_NE(&words.lease(row, 0), &words.lease(row, 1));
  }
  lines.push_back(offset(writer_tally(segment)));
  for (int row = 0; row < kReaderRows; ++row) lines.push_back(offset(reader_tally(segment, row)));
  for (std::size_t i = 0; i < lines.size(); ++i)
    EXPECT_EQ(lines[i], kControlOffset + i * kLineBytes) << "line " << i;
  EXPECT_GE(offset(*segment.slot_at(0)), lines.back() + kLineBytes);
  EXPECT_LE(segment.slot_at(kMaxSlots - 1) + sizeof(Note), segment.data() + segment.size());
  EXPECT_GE(static_cast<std::size_t>(segment.slot_at(1) - segment.slot_at(0)), sizeof(Note));
}

TEST(Segment, CannotBeResizedByAnyone) {
  const auto segment = make_ring<Note>(3);
  EXPECT_NE(::ftruncate(segment.fd(), 4096), 0);
  EXPECT_NE(::ftruncate(segment.fd(), 1 << 24), 0);
}

TEST(Segment, ImpossibleSizesAreABadConfiguration) {
  const auto attempt = [](int slots, std::size_t bytes) {
    return Segment::create({"test.ring", 1, bytes, slots, false});
  };
  for (const auto& segment : {attempt(1, 100), attempt(255, 100), attempt(-3, 100), attempt(4, 0),
                              attempt(4, kMaxPayloadBytes + 1), attempt(200, kMaxPayloadBytes)}) {
    ASSERT_FALSE(segment);
    EXPECT_EQ(segment.error().code, Errc::bad_config) << segment.error().what;
  }
  EXPECT_FALSE(Segment::create(RingSpec::of<Note>("", 4, false)));
  EXPECT_FALSE(Segment::create(RingSpec::of<Note>(std::string(64, 'x'), 4, false)));
}

TEST(Segment, WhatIsNotARingIsRefusedWithAReason) {
  EXPECT_THAT(refusal(-1), HasSubstr("not a usable ring"));
  const UniqueFd pipe_like(::open("/dev/null", O_RDWR | O_CLOEXEC));
  EXPECT_THAT(refusal(pipe_like.get()), HasSubstr("not a memory file"));

  const UniqueFd unsealed(::memfd_create("x", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  ASSERT_EQ(::ftruncate(unsealed.get(), 1 << 16), 0);
  EXPECT_THAT(refusal(unsealed.get()), HasSubstr("not sealed"));
  ASSERT_EQ(::fcntl(unsealed.get(), F_ADD_SEALS, F_SEAL_SHRINK), 0);
  EXPECT_THAT(refusal(unsealed.get()), HasSubstr("not sealed"));
  ASSERT_EQ(::fcntl(unsealed.get(), F_ADD_SEALS, F_SEAL_GROW), 0);
  EXPECT_THAT(refusal(unsealed.get()), HasSubstr("does not begin with the header of a ring"));

  const UniqueFd tiny(::memfd_create("x", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  ASSERT_EQ(::ftruncate(tiny.get(), 100), 0);
  ASSERT_EQ(::fcntl(tiny.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW), 0);
  EXPECT_THAT(refusal(tiny.get()), HasSubstr("only 100 bytes"));
}

TEST(Segment, AHeaderThatDiffersIsRefusedWithAReason) {
  const auto segment = make_ring<Note>(3);
  auto& header = header_of(segment);
  const auto good = header;
  const auto with = [&](auto change) {
    header = good;
    change(header);
    return refusal(segment.fd());
  };
  EXPECT_EQ(with([](SegmentHeader&) {}), "");
  EXPECT_THAT(with([](auto& h) { h.magic ^= 1; }), HasSubstr("header of a ring"));
  EXPECT_THAT(with([](auto& h) { h.layout_version = 7; }), HasSubstr("layout version 7"));
  EXPECT_THAT(with([](auto& h) { h.boot_id[3] ^= 1; }),
              HasSubstr("before the machine last started"));
  EXPECT_THAT(with([](auto& h) { h.stream.fill('x'); }), HasSubstr("not terminated"));
  EXPECT_THAT(with([](auto& h) { h.slot_count = 1; }), HasSubstr("1 slots"));
  EXPECT_THAT(with([](auto& h) { h.slot_count = 0xffffffff; }), HasSubstr("slots"));
  EXPECT_THAT(with([](auto& h) { h.slot_count = 40; }), HasSubstr("contradict"));
  EXPECT_THAT(with([](auto& h) { h.payload_bytes = ~0ull; }), HasSubstr("bytes"));
  EXPECT_THAT(with([](auto& h) { h.payload_bytes = 0; }), HasSubstr("0 bytes"));
  EXPECT_THAT(with([](auto& h) { h.slot_stride = 8; }), HasSubstr("contradict"));
  EXPECT_THAT(with([](auto& h) { h.slots_offset = 1ull << 40; }), HasSubstr("contradict"));
  EXPECT_THAT(with([](auto& h) { h.reader_rows = 99; }), HasSubstr("contradict"));
  EXPECT_THAT(with([](auto& h) { h.slot_count = 100, h = with_sizes(h); }),
              HasSubstr("the memory has"));
}

TEST(Segment, AHeaderChangedAfterOpeningChangesNoBound) {
  const auto segment = make_ring<Note>(3);
  const auto opened = again(segment);
  header_of(segment).slot_count = 200;
  header_of(segment).payload_bytes = 1 << 20;
  EXPECT_EQ(opened.slots(), 3);
  EXPECT_EQ(opened.payload_bytes(), sizeof(Note));
}

UniqueFd read_only(const Segment& segment) {
  return UniqueFd(
      ::open(("/proc/self/fd/" + std::to_string(segment.fd())).c_str(), O_RDONLY | O_CLOEXEC));
}

TEST(Segment, ADescriptorForReadingGivesAMappingToLookAtAndNoReaderOrWriter) {
  const auto segment = make_ring<Note>(3);
  const auto opened = must(Segment::open(read_only(segment)));
  EXPECT_EQ(opened.stream(), segment.stream());
  EXPECT_DEATH(*opened.data() = std::byte{1}, "");
  for (const auto& error :
       {Reader<Note>::attach(must(Segment::open(read_only(segment)))).error(),
        Writer<Note>::attach(must(Segment::open(read_only(segment)))).error()}) {
    EXPECT_EQ(error.code, Errc::unavailable);
    EXPECT_THAT(error.what, HasSubstr("fewer rights"));
  }
}

void touch(std::byte* byte) { *const_cast<volatile std::byte*>(byte) = std::byte{0}; }

TEST(Segment, AMappingWithoutARightDiesWhenItIsUsed) {
  const auto made = make_ring<Note>(3);
  const auto restricted = [&](Access access) {
    auto segment = again(made);
    EXPECT_TRUE(segment.restrict_to(access));
    return segment;
  };
  const auto control = [](const Segment& segment) { return segment.data() + kControlOffset; };
  const auto to_write = restricted(Access::write), to_read = restricted(Access::read),
             to_look = restricted(Access::look);
  EXPECT_DEATH(touch(to_write.data()), "");
  touch(control(to_write));
  touch(to_write.slot_at(0));
  EXPECT_DEATH(touch(to_read.data()), "");
  EXPECT_DEATH(touch(to_read.slot_at(0)), "");
  EXPECT_DEATH(touch(to_read.slot_at(2)), "");
  touch(control(to_read));
  EXPECT_DEATH(touch(to_look.data()), "");
  EXPECT_DEATH(touch(control(to_look)), "");
  EXPECT_DEATH(touch(to_look.slot_at(0)), "");
}

TEST(Segment, ARightThatWasTakenIsNotGivenBack) {
  auto segment = make_ring<Note>(3);
  EXPECT_TRUE(segment.restrict_to(Access::write));
  EXPECT_TRUE(segment.restrict_to(Access::look));
  auto moved = std::move(segment);
  EXPECT_FALSE(moved.restrict_to(Access::read));
  EXPECT_EQ(moved.restrict_to(Access::write).error().code, Errc::unavailable);
}

TEST(Segment, MemoryOfAnotherUserIsRefused) {
  const auto segment = make_ring<Note>(3);
  if (::geteuid() != 0) GTEST_SKIP() << "only the superuser can give memory away";
  ASSERT_EQ(::fchown(segment.fd(), 12345, 12345), 0);
  EXPECT_THAT(refusal(segment.fd()), HasSubstr("it belongs to user 12345"));
}

TEST(Segment, ARingOfAnotherTypeIsRefusedByReadersAndWriters) {
  const auto segment = make_ring<Note>(3);
  const auto reader = Reader<OtherNote>::attach(again(segment));
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().code, Errc::bad_data);
  EXPECT_THAT(reader.error().what, HasSubstr("another type of message than OtherNote/1"));
  const auto writer = Writer<OtherNote>::attach(again(segment));
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().code, Errc::bad_data);
}

TEST(Segment, SlotsOneByteTooSmallForTheMessageAreRefusedByEveryone) {
  const auto segment = make_ring<Page>(3, false, sizeof(Page) - 1);
  const auto expect_refused = [](const auto& attached) {
    ASSERT_FALSE(attached);
    EXPECT_EQ(attached.error().code, Errc::bad_data);
    EXPECT_THAT(attached.error().what, HasSubstr("too small for Page/1"));
  };
  expect_refused(Reader<Page>::attach(again(segment)));
  expect_refused(Reader<Page>::watch(again(segment)));
  expect_refused(Writer<Page>::attach(again(segment)));
}

TEST(Segment, SlotsOfExactlyTheSizeOfTheMessageAreUsedByEveryone) {
  const auto segment = make_ring<Page>(3, false, sizeof(Page));
  EXPECT_TRUE(Reader<Page>::attach(again(segment)));
  EXPECT_TRUE(Reader<Page>::watch(again(segment)));
  EXPECT_TRUE(Writer<Page>::attach(again(segment)));
}

}  // namespace
}  // namespace handcast::ipc
