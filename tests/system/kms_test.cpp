// SPDX-License-Identifier: Apache-2.0
// A rig whose light needs no window system. Its processes see an emulated graphics card.
#include <gmock/gmock.h>

#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;

class LightWithoutAWindowSystem : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
#ifdef HANDCAST_WITH_SANITIZER
    GTEST_SKIP() << "a sanitizer must be loaded before the emulated card";
#endif
  }
  /// `handcast up` with a card that has a display of this model; without a card if it is empty.
  std::unique_ptr<Command> up_with_display(const char* model) const {
    const Variable preload("LD_PRELOAD", HANDCAST_EMULATED_CARD_LIBRARY),
        display("HANDCAST_EMULATED_CARD", model);
    return up({"--set", "projector.backend=kms"});
  }
};

TEST_F(LightWithoutAWindowSystem, FlowsAndTheKernelSaysWhenItCame) {
  const auto rig = up_with_display("EPSON PJ");
  wait_until_light();
  expect_more_light();
  EXPECT_EQ(status()["light"]["projector"]["times_by"], "kernel");
  EXPECT_THAT(handcast({"status"}).output, HasSubstr("times by the kernel"));
  EXPECT_THAT(handcast({"latency"}).output, HasSubstr("times by the kernel"));
  EXPECT_THAT(rig->log(), HasSubstr("light on 'HDMI-A-1' of '/dev/dri/card0' (EPSON PJ), mode "
                                    "1024x768@60"));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(LightWithoutAWindowSystem, WithoutACardTheRigSaysWhyAndGoesOn) {
  const auto rig = up_with_display("");
  EXPECT_TRUE(eventually([&] {
    return rig->log().find("projector 'kms': there is no graphics card") != std::string::npos;
  }));
  EXPECT_TRUE(eventually([&] { return service("camera")["state"] == "ready"; }));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

}  // namespace
}  // namespace handcast::system_test
