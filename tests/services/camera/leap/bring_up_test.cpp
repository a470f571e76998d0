// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/bring_up.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/scratch.hpp"

namespace handcast::camera::leap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(LeapBringUp, EveryStepIsRead) {
  const auto steps = parse_bring_up(
      "# a comment\n"
      "write 21 01 0300 0500 42 00   # the left LED\n"
      "\n"
      "pause 20\n"
      "set 2 0x0b 73a\r\n"
      "read a1 81 0100 0001 1a",
      "file");
  ASSERT_TRUE(steps) << steps.error().what;
  ASSERT_EQ(steps->size(), 3u);
  EXPECT_EQ(steps->at(0).transfer.index, 0x0500);
  EXPECT_EQ(steps->at(0).transfer.data, (std::vector<std::uint8_t>{0x42, 0}));
  EXPECT_EQ(steps->at(1).pause_ns, 20'000'000);
  EXPECT_EQ(steps->at(1).transfer.value, 0x0b00);
  EXPECT_EQ(steps->at(1).transfer.data, (std::vector<std::uint8_t>{0x3a, 0x07}));
  EXPECT_EQ(steps->at(2).transfer.length, 26);
  EXPECT_EQ(steps->at(2).pause_ns, 0);
  EXPECT_EQ(steps->at(2).line, 6);
}

TEST(LeapBringUp, AllFaultsAreSaidWithTheirLines) {
  const auto steps = parse_bring_up(
      "jump 1\nset 5 3\nset 5 3 10000\nwrite 21 01\nread 21 81 0 0 1\npause x\nset 5 3 0\n",
      "my.txt");
  ASSERT_FALSE(steps);
  EXPECT_EQ(steps.error().code, Errc::bad_config);
  EXPECT_THAT(steps.error().what,
              AllOf(HasSubstr("my.txt:1: 'jump' is no step; there are: write, read, set, pause"),
                    HasSubstr("my.txt:2: `set`"), HasSubstr("my.txt:3: '10000'"),
                    HasSubstr("my.txt:4: `write`"), HasSubstr("my.txt:5: `read`"),
                    HasSubstr("my.txt:6: 'x' is not a decimal")));
  EXPECT_EQ(std::ranges::count(steps.error().what, '\n'), 5);
}

TEST(LeapBringUp, WhatIsShippedSwitchesBothOff) {
  const auto steps = load_bring_up({});
  ASSERT_TRUE(steps) << steps.error().what;
  ASSERT_EQ(steps->size(), 2u);
  EXPECT_EQ(steps->at(1).transfer.data, (std::vector<std::uint8_t>{1, 0}));
}

TEST(LeapBringUp, AFileThatIsNoneIsSaid) {
  const test::Scratch scratch;
  EXPECT_THAT(load_bring_up(scratch.path()).error().what, HasSubstr("is not a file"));
  EXPECT_THAT(load_bring_up("/dev/zero").error().what, HasSubstr("is not a file"));
  const auto file = std::filesystem::path(scratch.path()) / "long";
  std::ofstream(file) << std::string(2 << 20, 'x');
  EXPECT_THAT(load_bring_up(file).error().what, HasSubstr("too long"));
}

}  // namespace
}  // namespace handcast::camera::leap
