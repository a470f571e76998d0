// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/options.hpp"

#include <gmock/gmock.h>

#include <array>

#include "ipc/base/version.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::service {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

Result<Options> parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "handcast-camera");
  static const std::array kInstances{
      Instance{{.name = "camera", .summary = "Delivers images.", .paced_by = "a clock"}, {}},
      Instance{{.name = "camera2", .summary = "Delivers others.", .paced_by = "a clock"}, {}}};
  return parse_options(kInstances, static_cast<int>(arguments.size()), arguments.data());
}

TEST(DaemonOptions, SettingsKeepTheirOrder) {
  const auto options = parse({"--set", "a.b=1", "--config=rig.toml", "--set", "a.b=x=y"});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->config_file, "rig.toml");
  EXPECT_THAT(options->settings, ElementsAre("a.b=1", "a.b=x=y"));
  EXPECT_EQ(options->answer, std::nullopt);
}

TEST(DaemonOptions, AnInstanceIsNamed) {
  const auto name = [](const Result<Options>& options) {
    return options->instance->description.name;
  };
  EXPECT_EQ(name(parse({"--as", "camera2", "--config", "rig.toml"})), "camera2");
  EXPECT_EQ(name(parse({"--config", "rig.toml"})), "camera");
  EXPECT_THAT(*parse({"--describe", "--as", "camera2"})->answer, HasSubstr("camera2.process"));
  EXPECT_THAT(*parse({"--help"})->answer, HasSubstr("The service that it is: camera, camera2"));
}

TEST(DaemonOptions, WhatCannotBeUnderstoodIsNamed) {
  EXPECT_THAT(parse({"--config"}).error().what, HasSubstr("--config needs a value"));
  EXPECT_EQ(parse({"--frobnicate"}).error().what,
            "unknown option '--frobnicate'; `handcast-camera --help`");
  EXPECT_THAT(parse({}).error().what, HasSubstr("handcast up"));
  EXPECT_EQ(parse({}).error().code, Errc::bad_config);
}

TEST(DaemonOptions, ACheckNeedsARig) {
  EXPECT_TRUE(parse({"--config", "rig.toml", "--check"})->check);
  EXPECT_THAT(parse({"--check"}).error().what, HasSubstr("--config FILE is missing"));
}

TEST(DaemonOptions, QuestionsNeedNoConfiguration) {
  EXPECT_THAT(*parse({"--backends"})->answer, AnyOf(IsEmpty(), HasSubstr("From /")))
      << "it has none but the files of this build";
  EXPECT_THAT(*parse({"--describe"})->answer, HasSubstr("camera.process"));
  EXPECT_THAT(*parse({"--version"})->answer, StartsWith("handcast-camera "));
  EXPECT_THAT(*parse({"-h"})->answer, HasSubstr("Delivers images."));
}

TEST(DaemonOptions, DevicesAreAskedForWhereBackEndsFindAny) {
  EXPECT_THAT(parse({"--attached"}).error().what, HasSubstr("unknown option '--attached'"));
  daemon::Search asked;
  const std::array instances{Instance{{.name = "camera"}, {}, {}, [&](const auto& search) {
                                        asked = search;
                                        return std::vector{daemon::Attached{.name = "GV01"}};
                                      }}};
  const auto answer = [&](std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), {"handcast-camera", "--attached"});
    return parse_options(instances, static_cast<int>(arguments.size()), arguments.data())->answer;
  };
  EXPECT_EQ(daemon::attached_from(*answer({})).value()[0].name, "GV01");
  EXPECT_EQ(asked.name, "");
  EXPECT_TRUE(asked.opens);
  answer({"--named", "7", "--untouched"});
  EXPECT_EQ(asked.name, "7");
  EXPECT_FALSE(asked.opens);
}

TEST(BackEndFiles, AreThoseOfThisVersion) {
  EXPECT_THAT(kAbi.version, StartsWith(std::string(version()) + "-"));
}

}  // namespace
}  // namespace handcast::service
