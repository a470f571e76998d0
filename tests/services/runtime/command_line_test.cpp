// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/command_line.hpp"

#include <gmock/gmock.h>

namespace handcast::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Result<CommandLine> parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "handcast-camera");
  return parse_command_line(static_cast<int>(arguments.size()), arguments.data());
}

TEST(CommandLine, SettingsKeepTheirOrder) {
  const auto line = parse({"--set", "a.b=1", "--config", "rig.toml", "--set", "a.b=x=y"});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->config_file, "rig.toml");
  EXPECT_THAT(line->settings, ElementsAre("a.b=1", "a.b=x=y"));
}

TEST(CommandLine, AnInstanceIsNamed) {
  EXPECT_EQ(parse({"--as", "camera2", "--config", "rig.toml"})->instance, "camera2");
  EXPECT_EQ(parse({"--config", "rig.toml"})->instance, "");
}

TEST(CommandLine, WhatCannotBeUnderstoodIsNamed) {
  EXPECT_THAT(parse({"--config"}).error().what, HasSubstr("--config needs a value"));
  EXPECT_THAT(parse({"--frobnicate"}).error().what, HasSubstr("'--frobnicate'"));
  EXPECT_THAT(parse({"--config", "rig.toml", "--set", "rate"}).error().what,
              HasSubstr("path=value"));
  EXPECT_THAT(parse({}).error().what, HasSubstr("handcast up"));
  EXPECT_EQ(parse({}).error().code, Errc::bad_config);
}

TEST(CommandLine, ACheckNeedsARig) {
  EXPECT_EQ(parse({"--config", "rig.toml", "--check"})->task, CommandLine::Task::check);
  EXPECT_THAT(parse({"--check"}).error().what, HasSubstr("--config FILE is missing"));
}

TEST(CommandLine, QuestionsNeedNoConfiguration) {
  EXPECT_EQ(parse({"--backends"})->task, CommandLine::Task::backends);
  EXPECT_EQ(parse({"--version"})->task, CommandLine::Task::version);
  EXPECT_EQ(parse({"--help"})->task, CommandLine::Task::help);
}

}  // namespace
}  // namespace handcast::service
