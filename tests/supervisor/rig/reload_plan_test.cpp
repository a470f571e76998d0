// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/reload_plan.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "config/live/live_board.hpp"
#include "tests/supervisor/spec/built_catalogue.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

config::Rig desk() {
  config::Rig rig;
  rig.name = "desk";
  rig.observer.enabled = false;
  return rig;
}

/// A rig whose services have begun and stopped, so that no process is needed.
class Plan : public testing::Test {
 protected:
  void SetUp() override {
    rig_.catalogue = test::built_catalogue();
    for (const auto& spec : services_of(rig_.config, rig_.catalogue))
      inherit(rig_.services.add(spec), State::stopped);
  }
  static void inherit(Service& service, State state, std::string swapped = "") {
    service.inherit({.name = service.spec().name,
                     .state = state,
                     .swapped = std::move(swapped),
                     .fingerprint = service.spec().fingerprint});
  }

  /// What people change while the rig is up.
  void set(const std::string& assignment) {
    if (!rig_.make_rings({})) throw std::runtime_error("no rings");
    const auto fd = *daemon::find_ring(rig_.rings.descriptors(), msg::kLiveSettings);
    config::LiveBoard board(*ipc::Segment::open(UniqueFd(::dup(fd))), rig_.config, {});
    const auto done = board.set({&assignment, 1}, "test");
    if (!done) throw std::runtime_error(done.error().what);
  }

  EventLoop loop_ = EventLoop::open().value();
  LiveRig rig_{desk(), loop_, [](Service&, Notice) {}};
};

TEST_F(Plan, TheSameFileChangesNothing) {
  const auto plan = plan_reload(rig_, desk(), true);
  EXPECT_FALSE(plan.changed);
  EXPECT_THAT(plan.restarted, IsEmpty());
  EXPECT_THAT(plan.started, IsEmpty());
  EXPECT_THAT(plan.stopped, IsEmpty());
  EXPECT_TRUE(check_reload(rig_, plan));
}

TEST_F(Plan, TheServicesThatReadWhatChangedAreRestarted) {
  auto wanted = desk();
  wanted.camera.rate_hz += 10;
  const auto plan = plan_reload(rig_, wanted, true);
  EXPECT_TRUE(plan.changed);
  EXPECT_THAT(plan.restarted, ElementsAre("camera", "landmarks"));
}

TEST_F(Plan, AServiceThatHasNotBegunNeedsNoRestart) {
  auto wanted = desk();
  wanted.observer.enabled = true;
  EXPECT_THAT(plan_reload(rig_, wanted, true).started, ElementsAre("observer"));
  for (auto& spec : services_of(wanted, rig_.catalogue))
    if (spec.name == "observer") rig_.services.add(spec).hold();
  wanted.observer.rate_hz += 1;
  const auto plan = plan_reload(rig_, wanted, true);
  EXPECT_THAT(plan.started, IsEmpty());
  EXPECT_THAT(plan.restarted, IsEmpty());
}

TEST_F(Plan, AServiceThatIsNotInTheFileAnyMoreIsStopped) {
  rig_.services.add({.name = "observer"});
  EXPECT_THAT(plan_reload(rig_, desk(), true).stopped, ElementsAre("observer"));
}

TEST_F(Plan, OneThatHasGivenUpIsTriedAgainOnlyIfAPersonAsks) {
  inherit(*rig_.services.find("pose"), State::failed);
  EXPECT_THAT(plan_reload(rig_, desk(), true).restarted, ElementsAre("pose"));
  EXPECT_THAT(plan_reload(rig_, desk(), false).restarted, IsEmpty());
}

TEST_F(Plan, ASwappedBackEndStaysUntilTheFileNamesAnother) {
  auto& camera = *rig_.services.find("camera");
  inherit(camera, State::stopped, "replay");
  const auto backend = [](const ReloadPlan& plan) { return plan.specs.front().backend; };
  EXPECT_EQ(backend(plan_reload(rig_, desk(), true)), "replay");
  auto wanted = desk();
  wanted.camera.backend = "file";
  EXPECT_EQ(backend(plan_reload(rig_, wanted, true)), "file");
}

TEST_F(Plan, ALiveSettingThatRunsAlreadyRestartsNobodyAndFallsBackAsBefore) {
  set("projector.brightness=0.5");
  auto wanted = desk();
  wanted.projector.brightness = 0.5;  // as after `handcast save`
  auto plan = plan_reload(rig_, wanted, true);
  EXPECT_FALSE(plan.changed);
  EXPECT_THAT(plan.restarted, IsEmpty());
  EXPECT_EQ(plan.config.projector.brightness, desk().projector.brightness);

  wanted.camera.rate_hz += 10;
  EXPECT_THAT(plan_reload(rig_, wanted, true).restarted, ElementsAre("camera", "landmarks"));
  wanted = desk();
  wanted.projector.brightness = 0.25;
  plan = plan_reload(rig_, wanted, true);
  EXPECT_THAT(plan.restarted, testing::Contains("projector"));
  EXPECT_EQ(plan.config.projector.brightness, 0.25);
}

TEST_F(Plan, ARigKeepsItsNameWhileItIsUp) {
  auto wanted = desk();
  wanted.name = "wall";
  const auto possible = check_reload(rig_, plan_reload(rig_, wanted, true));
  ASSERT_FALSE(possible);
  EXPECT_EQ(possible.error().code, Errc::bad_config);
  EXPECT_THAT(possible.error().what, HasSubstr("'desk' to 'wall'"));
}

}  // namespace
}  // namespace handcast::supervisor
