// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/probe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/services/pose/openxr/scripted_runtime.hpp"

namespace handcast::pose::openxr {
namespace {

using testing::HasSubstr;

TEST(Probe, SaysWhichRuntimeAnswers) {
  const test::ScriptedRuntime runtime;
  const auto found = probe(runtime.rig().pose.openxr);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(*found, "Test Runtime 0.1.2, 'Test Tracker'");
}

TEST(Probe, PassesTheRefusalOn) {
  const test::ScriptedRuntime runtime("lacks XR_MND_headless");
  const auto found = probe(runtime.rig().pose.openxr);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::bad_config);
  EXPECT_THAT(found.error().what, HasSubstr("draws nothing"));
}

TEST(Probe, ACrashOfTheRuntimeIsNotOurs) {
  const test::ScriptedRuntime runtime("crashes");
  const auto found = probe(runtime.rig().pose.openxr);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::unavailable);
  EXPECT_THAT(found.error().what, HasSubstr("crashed"));
}

}  // namespace
}  // namespace handcast::pose::openxr
