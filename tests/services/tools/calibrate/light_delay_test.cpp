// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/light_delay.hpp"

#include <gmock/gmock.h>

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;

Outcome reported(double low_ms, double high_ms) {
  Outcome outcome;
  config::Rig rig;
  rig.projector.latency_ms = 8;
  report_delay(rig, {(low_ms + high_ms) / 2, low_ms, high_ms}, outcome);
  return outcome;
}

TEST(DelayReport, AnIntervalThatIsPrintedAsTouchingZeroIsNoChange) {
  for (const auto& outcome : {reported(0.04, 1.2), reported(-1.2, -0.04)}) {
    EXPECT_TRUE(outcome.settings.empty());
    EXPECT_THAT(outcome.findings.front(), HasSubstr("comes when it is reported"));
  }
}

TEST(DelayReport, AnIntervalBesideZeroIsAChange) {
  const auto outcome = reported(0.2, 1.2);
  ASSERT_EQ(outcome.settings.size(), 1U);
  EXPECT_EQ(outcome.settings.front().value, "8.7");
}

}  // namespace
}  // namespace handcast::calibrate
