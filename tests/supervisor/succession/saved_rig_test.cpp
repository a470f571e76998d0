// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/saved_rig.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

SavedRig saved_desk() {
  return {.name = "desk",
          .rig_file = "/rigs/desk.toml",
          .settings = {"camera.rate_hz=60", "name=\"desk\""},
          .out = "/tmp/out",
          .applied = "name = \"desk\"\n",
          .epoch_ns = 42,
          .rings = {{"camera.frames", 123456789012345, 64}},
          .services = {{"pose", 4711, 99887766, State::ready, "replay", "abcdef", 3},
                       {"camera", 0, 0, State::failed, "", "", 0}}};
}

void expect_invalid(const std::string& text, std::string_view why) {
  const auto parsed = parse_saved(text, "desk");
  ASSERT_FALSE(parsed) << "accepted: " << text;
  EXPECT_EQ(parsed.error().code, Errc::bad_data);
  EXPECT_THAT(parsed.error().what, HasSubstr(std::string(why)));
}

std::string with(const std::string& from, const std::string& to) {
  auto changed = print_saved(saved_desk());
  const auto at = changed.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return changed.replace(at, from.size(), to);
}

TEST(SavedRig, WhatIsPrintedIsParsedAgain) {
  const auto parsed = parse_saved(print_saved(saved_desk()), "desk");
  ASSERT_TRUE(parsed) << parsed.error().what;
  const auto& rig = *parsed;
  EXPECT_EQ(rig.rig_file, "/rigs/desk.toml");
  EXPECT_EQ(rig.settings, saved_desk().settings);
  EXPECT_EQ(rig.out, "/tmp/out");
  EXPECT_EQ(rig.applied, "name = \"desk\"\n");
  EXPECT_EQ(rig.epoch_ns, 42);
  ASSERT_THAT(rig.rings, SizeIs(1));
  EXPECT_EQ(rig.rings[0].stream, "camera.frames");
  EXPECT_EQ(rig.rings[0].inode, 123456789012345u);
  EXPECT_EQ(rig.rings[0].fd, 64);
  ASSERT_THAT(rig.services, SizeIs(2));
  EXPECT_EQ(rig.services[0].pid, 4711);
  EXPECT_EQ(rig.services[0].started_ticks, 99887766u);
  EXPECT_EQ(rig.services[0].state, State::ready);
  EXPECT_EQ(rig.services[0].swapped, "replay");
  EXPECT_EQ(rig.services[0].fingerprint, "abcdef");
  EXPECT_EQ(rig.services[0].restarts, 3);
  EXPECT_EQ(rig.services[1].state, State::failed);
}

TEST(SavedRig, AnIncompleteTextIsAnErrorAtEveryLength) {
  const auto whole = print_saved(saved_desk());
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(parse_saved(whole.substr(0, length), "desk")) << length;
}

TEST(SavedRig, NumbersThatCouldHitOthersAreAnError) {
  for (const auto* pid : {"-1", "1", "99999999", "\"4711\"", "1e300"})
    EXPECT_FALSE(parse_saved(with("\"pid\":4711", fmt::format("\"pid\":{}", pid)), "desk")) << pid;
  for (const auto* fd : {"-1", "0", "2", "null"})
    EXPECT_FALSE(parse_saved(with("\"fd\":64", fmt::format("\"fd\":{}", fd)), "desk")) << fd;
  expect_invalid(with("\"name\":\"desk\"", "\"name\":\"sofa\""), "named 'sofa'");
  expect_invalid(with("\"version\":3", "\"version\":2"), "another version");
}

}  // namespace
}  // namespace handcast::supervisor
