// SPDX-License-Identifier: Apache-2.0
#include "services/desk/lamp/lamp.hpp"

#include <gtest/gtest.h>

#include "tests/services/desk/lamp/pjlink_projector.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk {
namespace {

using namespace std::chrono_literals;

class LampSetting : public testing::Test {
 protected:
  void open() {
    rig.projector.lamp.pjlink = "127.0.0.1:" + projector.place.port;
    auto opened = open_lamp(rig, panel, {.answer = 200ms, .again = 20ms});
    ASSERT_TRUE(opened) << opened.error().what;
    lamp = std::move(*opened);
  }
  void set(const std::string& word) {
    const std::vector<std::string> change{"light.lamp=" + word};
    ASSERT_TRUE(panel.set(change, "test"));
  }
  /// Turns until a command of the projector has a value; false after 10 s.
  bool becomes(const std::string& command, const std::string& value) {
    for (const auto until = Deadline::in(10s); !until.passed();) {
      scene.now_ns = now_ns();
      lamp->turn(scene);
      if (projector.state(command) == value) return true;
      sleep_until_ns(now_ns() + to_ns(5ms));
    }
    return false;
  }

  test::PjlinkProjector projector;
  config::Rig rig;
  test::TablePanel panel;
  std::unique_ptr<Surface> lamp;
  Scene scene;
};

TEST_F(LampSetting, WithoutAPlaceThereIsNone) {
  EXPECT_EQ(*open_lamp(rig, panel), nullptr);
  rig.projector.lamp.pjlink = ":";
  EXPECT_FALSE(open_lamp(rig, panel));
}

TEST_F(LampSetting, TheLampFollowsTheSetting) {
  open();
  set("mute");
  EXPECT_TRUE(becomes("AVMT", "31")) << "after it has warmed up";
  EXPECT_EQ(projector.state("POWR"), "1");
  set("on");
  EXPECT_TRUE(becomes("AVMT", "30"));
  set("off");
  EXPECT_TRUE(becomes("POWR", "0"));
}

TEST_F(LampSetting, AProjectorThatDoesNotAnswerIsToldAgain) {
  projector.greet("");
  open();
  set("on");
  EXPECT_FALSE([&] {
    for (int i = 0; i < 100; ++i) {
      scene.now_ns = now_ns();
      const auto begin_ns = now_ns();
      lamp->turn(scene);
      if (now_ns() - begin_ns > to_ns(100ms)) return true;
      sleep_until_ns(now_ns() + to_ns(5ms));
    }
    return false;
  }()) << "the desk waits for it";
  projector.greet("PJLINK 0\r");
  EXPECT_TRUE(becomes("POWR", "1"));
}

TEST_F(LampSetting, UnchangedLeavesItAlone) {
  open();
  for (int i = 0; i < 50; ++i) {
    scene.now_ns = now_ns();
    lamp->turn(scene);
    sleep_until_ns(now_ns() + to_ns(5ms));
  }
  EXPECT_TRUE(projector.commands().empty());
}

}  // namespace
}  // namespace handcast::desk
