// SPDX-License-Identifier: Apache-2.0
#include "supervisor/commands/choose_rig.hpp"

#include <gmock/gmock.h>

#include "ipc/control/choose_rig.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/daemon/contract.hpp"
#include "tests/supervisor/control/control_fixture.hpp"
#include "tests/system/variable.hpp"

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

TEST_F(ChooseRig, AProgramThatARigHasStartedMeansThatOne) {
  const auto desk = ControlServer::listen("desk", loop_, refuse);
  const auto wall = ControlServer::listen("wall", loop_, refuse);
  const system_test::Variable around(daemon::kRigVariable, control::address_of("wall")->text);
  EXPECT_EQ(control::choose_rig("").value(), "wall");
  EXPECT_EQ(control::choose_rig("desk").value(), "desk");
}

}  // namespace
}  // namespace handcast::supervisor
