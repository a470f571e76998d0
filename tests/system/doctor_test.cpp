// SPDX-License-Identifier: Apache-2.0
// `handcast doctor` with a rig that is up, and without one.
#include <gmock/gmock.h>

#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;

class Doctor : public SystemTest {
 protected:
  /// The finding of a check.
  nlohmann::json finding(const std::string& check) const {
    const auto outcome = handcast({"doctor", "config/rigs/twin.toml", "--seconds", "1", "--json"});
    for (const auto& each : nlohmann::json::parse(outcome.output))
      if (each["check"] == check) return each;
    return nullptr;
  }
};

TEST_F(Doctor, ARigThatIsUpIsWatched) {
  const auto rig = up();
  wait_until_light();
  EXPECT_EQ(finding("services")["grade"], "good");
  EXPECT_THAT(finding("camera rate")["sentence"].get<std::string>(), HasSubstr(" Hz of "));
  EXPECT_EQ(finding("hand")["grade"], "good");
  EXPECT_EQ(finding("background")["grade"], "good");
  EXPECT_FALSE(finding("light of projector").is_null());
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(Doctor, ARigThatCannotStartHasAFaultThatSaysWhy) {
  const auto outcome = handcast({"doctor", "config/rigs/replay.toml", "--json"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("pose 'replay'"));
  EXPECT_EQ(finding("start")["grade"], "good");
}

TEST_F(Doctor, ARigThatIsNotUpGetsTheAdviceToStartIt) {
  const auto rig = finding("rig");
  EXPECT_EQ(rig["grade"], "advice");
  EXPECT_THAT(rig["remedy"].get<std::string>(), HasSubstr("handcast up"));
}

}  // namespace
}  // namespace handcast::system_test
