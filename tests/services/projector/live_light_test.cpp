// SPDX-License-Identifier: Apache-2.0
#include "services/projector/live_light.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "config/live/live_board.hpp"
#include "ipc/base/clock.hpp"

namespace handcast::projector {
namespace {

/// The light of a projector, between the board of a rig and a pipeline.
class LiveLightTest : public testing::Test {
 protected:
  ipc::Segment ring() const { return *ipc::Segment::open(UniqueFd(::dup(ring_.fd()))); }
  void set(const std::vector<std::string>& changes) {
    config::LiveBoard board(ring(), rig_, "");
    const auto done = board.set(changes, "test");
    ASSERT_TRUE(done) << done.error().what;
    bool is_there = false;
    for (const auto until = Deadline::in(std::chrono::seconds(5)); !is_there && !until.passed();)
      is_there = light_.follow(now_ns());
    ASSERT_TRUE(is_there);
  }

  config::Rig rig_ = [] {
    config::Rig rig;
    rig.projector.fade_s = 0;
    return rig;
  }();
  ipc::Segment ring_ =
      *ipc::Segment::create(ipc::RingSpec::of<msg::LiveSettings>("live.settings", 8, false));
  std::unique_ptr<service::LiveSettings> live_ = *service::LiveSettings::follow(rig_, ring());
  std::unique_ptr<renderer::Pipeline> pipeline_ =
      *renderer::Pipeline::create(rig_.cascade, rig_.content, rig_.hand, calib::reference_rig());
  Brightness brightness_{rig_.projector, rig_.light, 1};
  LiveLight light_{*live_, rig_, config::Viewpoint::first, *pipeline_, brightness_, 1024, 768};
};

TEST_F(LiveLightTest, ChangesArriveBetweenTwoFrames) {
  EXPECT_FALSE(light_.follow(now_ns()));
  set({"light.blackout=true", "light.freeze=true"});
  EXPECT_EQ(brightness_.fade_at(now_ns()), 0);
  EXPECT_TRUE(light_.is_frozen());
  EXPECT_FALSE(light_.follow(now_ns())) << "nothing else has changed";
  set({"light.blackout", "light.freeze", "light.master=0.5"});
  EXPECT_EQ(brightness_.fade_at(now_ns()), 0.5);
  EXPECT_FALSE(light_.is_frozen());
  set({"projector.brightness=0.25"});
  EXPECT_EQ(light_.settings()->brightness, 0.25);
}

TEST_F(LiveLightTest, TheSecondProjectorHasABrightnessOfItsOwn) {
  LiveLight second{*live_, rig_, config::Viewpoint::second, *pipeline_, brightness_, 1024, 768};
  config::LiveBoard board(ring(), rig_, "");
  const std::vector<std::string> both{"projector.brightness=0.25", "projector2.brightness=0.75"};
  ASSERT_TRUE(board.set(both, "test"));
  bool is_there = false;
  for (const auto until = Deadline::in(std::chrono::seconds(5)); !is_there && !until.passed();)
    is_there = second.follow(now_ns());
  ASSERT_TRUE(is_there);
  EXPECT_EQ(second.settings()->brightness, 0.75);
}

TEST_F(LiveLightTest, AProcessThatIsStartedLaterHasThemFromTheStart) {
  set({"light.master=0.25"});
  EXPECT_EQ(service::LiveSettings::newest(rig_, ring()).rig.light.master, 0.25);
  auto other_file = rig_;
  other_file.cascade.correct.bone_short_px = 20;
  set({"cascade.correct.bone_long_px=10"});
  EXPECT_EQ(service::LiveSettings::newest(other_file, ring()).rig.cascade.correct.bone_long_px, 24)
      << "values that do not fit to another file are left out";
}

TEST_F(LiveLightTest, ThePictureIsShiftedAndThenMirrored) {
  config::Light light{.flip = config::Flip::both, .shift_px = {2, -3}};
  const auto at = calib::mapped(placement(light, 1024, 768), {10, 20});
  EXPECT_EQ(at, glm::dvec2(1023 - 12, 767 - 17));
  light.flip = config::Flip::none;
  EXPECT_EQ(calib::mapped(placement(light, 1024, 768), {10, 20}), glm::dvec2(12, 17));
  set({"light.flip=horizontal", "light.shift_px=[0.5, 0]"});
  EXPECT_EQ(light_.flip(), config::Flip::horizontal);
}

}  // namespace
}  // namespace handcast::projector
