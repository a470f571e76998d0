// SPDX-License-Identifier: Apache-2.0
#include "supervisor/commands/choose_rig.hpp"

#include <gmock/gmock.h>

#include "tests/supervisor/control/control_fixture.hpp"

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;

void refuse(const Request&, const ControlServer::Reply& reply) { reply(failure("no")); }

using ChooseRig = Control;

TEST_F(ChooseRig, WithoutARigTheSentenceSaysHowToStartOne) {
  const auto rig = choose_rig("");
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().what, HasSubstr("handcast up"));
}

TEST_F(ChooseRig, TheOnlyRigNeedsNoNameAndOneOfSeveralDoes) {
  const auto desk = ControlServer::listen("desk", loop_, refuse);
  EXPECT_EQ(choose_rig("").value(), "desk");
  const auto wall = ControlServer::listen("wall", loop_, refuse);
  const auto unnamed = choose_rig("");
  ASSERT_FALSE(unnamed);
  EXPECT_THAT(unnamed.error().what, HasSubstr("desk, wall; choose one with --rig"));
  EXPECT_EQ(choose_rig("wall").value(), "wall");
  EXPECT_FALSE(choose_rig("floor"));
}

}  // namespace
}  // namespace handcast::supervisor
