// SPDX-License-Identifier: Apache-2.0
// Two rigs on two computers: the far one draws from the near one's tracker.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <cstring>
#include <map>
#include <optional>

#include "ipc/client/stream.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"
#include "tests/two_computers.hpp"

namespace handcast::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

class Bridge : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
    if (IsSkipped()) return;
    if (!std::filesystem::exists(program_folder() / "handcast-bridge"))
      GTEST_SKIP() << "this build has no bridge";
    scope_.emplace(control::kScopeVariable, scratch_.path().string());
    computers_.emplace();
    if (!computers_->is_connected())
      std::fprintf(stderr, "both rigs are on this computer: %s\n", computers_->kWhyNot);
  }
  bool is_connected() const { return computers_->is_connected(); }

  static Arguments settings(const std::string& name, const Arguments& more) {
    Arguments arguments{"up", "config/rigs/twin.toml", "--set", "name=" + name};
    for (const auto* setting :
         {"camera.rate_hz=30", "projector.rate_hz=30", "observer.enabled=false",
          "supervisor.ready_s=60", "twin.motion=builtin:wave", "bridge.domain=7"})
      arguments.insert(arguments.end(), {"--set", setting});
    for (const auto& setting : more) arguments.insert(arguments.end(), {"--set", setting});
    return arguments;
  }
  Arguments network(bool is_near) const {
    if (!is_connected()) return {};
    return {std::string("bridge.interface=") + (is_near ? "near0" : "far0"),
            fmt::format("bridge.peers=['{}']",
                        is_near ? test::TwoComputers::kFar : test::TwoComputers::kNear)};
  }
  std::unique_ptr<Command> up_near(const std::string& name = "near") const {
    auto more = network(true);
    more.insert(more.end(), {"bridge.send=['pose.hands', 'landmarks.hands', 'live.settings']",
                             "landmarks.backend=twin"});
    return computers_->in_near(
        [&] { return std::make_unique<Command>(scratch_.path(), settings(name, more)); });
  }
  std::unique_ptr<Command> up_far(const Arguments& extra = {}) const {
    auto more = network(false);
    more.insert(more.end(),
                {"bridge.receive=['pose.hands', 'landmarks.hands', 'live.settings']",
                 "camera.backend=external", "pose.backend=external", "landmarks.backend=external",
                 "cascade.fill.method=none", "cascade.register.method=none"});
    more.insert(more.end(), extra.begin(), extra.end());
    return computers_->in_far(
        [&] { return std::make_unique<Command>(scratch_.path(), settings("far", more)); });
  }
  /// `handcast VERB` about one of the rigs.
  Outcome about(const std::string& rig, Arguments words) const {
    words.insert(words.end(), {"--rig", rig});
    const auto ask = [&] { return handcast(words); };
    return rig == "far" ? computers_->in_far(ask) : computers_->in_near(ask);
  }
  nlohmann::json status_of(const std::string& rig) const {
    const auto outcome = about(rig, {"status", "--json"});
    return outcome.exit_code == 0 ? nlohmann::json::parse(outcome.output) : nlohmann::json();
  }
  std::uint64_t count_of(const std::string& rig, const char* ring) const {
    const auto now = status_of(rig);
    return now.is_object() ? now["rings"][ring].value("count", std::uint64_t{0}) : 0;
  }
  bool grows(const std::string& rig, const char* ring, std::uint64_t by = 20) const {
    const auto before = count_of(rig, ring);
    return eventually([&] { return count_of(rig, ring) >= before + by; });
  }
  static bool is_said(const Command& rig, const std::string& sentence) {
    return eventually([&] { return rig.log().find(sentence) != std::string::npos; });
  }
  void expect_no_harm(const std::string& rig) const {
    for (const auto& [name, service] : status_of(rig)["services"].items()) {
      EXPECT_EQ(service["restarts"], 0) << rig << " " << name;
      EXPECT_EQ(service["state"], "ready") << rig << " " << name;
    }
  }
  template <class Message>
  static Result<client::Stream<Message>> stream(const std::string& rig, const char* name) {
    return client::open_stream<Message>(rig, name);
  }

  std::optional<Variable> scope_;  // of the streams that this process reads
  std::optional<test::TwoComputers> computers_;
};

/// The place of a joint tells which sample of the near tracker it is.
std::optional<float> sign_of(const msg::HandPoses& poses) {
  if (poses.count == 0) return std::nullopt;
  return poses.hands[0].joints[5].position_m[0];
}

TEST_F(Bridge, TheFarComputerDrawsFromTheNearOnesTrackerByItsOwnClock) {
  const auto near = up_near();
  const bool has_clocks = is_connected() && computers_->set_far_clock();
  const auto far = up_far();
  ASSERT_TRUE(is_said(*far, "pose.hands comes from near@")) << far->log() << near->log();
  ASSERT_TRUE(is_said(*far, "landmarks.hands comes from near@")) << far->log();
  ASSERT_TRUE(is_said(*far, "its clock is")) << far->log();
  EXPECT_TRUE(grows("far", "pose.hands"));
  EXPECT_TRUE(grows("far", "landmarks.hands"));
  EXPECT_THAT(about("far", {"status"}).output,
              HasSubstr("bridge: times of the other computer are known to"));

  auto theirs = computers_->in_near([&] { return stream<msg::HandPoses>("near", "pose.hands"); });
  auto ours = computers_->in_far([&] { return stream<msg::HandPoses>("far", "pose.hands"); });
  ASSERT_TRUE(theirs && ours);
  std::map<float, std::int64_t> origins;
  int compared = 0;
  const auto ahead_ns = has_clocks ? test::TwoComputers::kAhead_s * 1'000'000'000LL : 0;
  for (const auto until = Deadline::in(20s); compared < 50 && !until.passed();) {
    while (const auto poses = theirs->next(Deadline::now()))
      if (const auto sign = sign_of(**poses)) origins[*sign] = (*poses)->header.origin_ns;
    const auto poses = ours->next(Deadline::in(100ms));
    const auto sign = poses ? sign_of(**poses) : std::nullopt;
    if (!sign || !origins.contains(*sign)) continue;
    EXPECT_NEAR(ns_to_ms((*poses)->header.origin_ns - ahead_ns - origins[*sign]), 0, 2);
    ++compared;
  }
  EXPECT_EQ(compared, 50);

  auto light =
      computers_->in_far([&] { return stream<msg::Projection>("far", "projection.frames"); });
  ASSERT_TRUE(light);
  EXPECT_TRUE(eventually([&] {
    const auto frame = light->latest(Deadline::in(100ms));
    return frame && (*frame)->made_from.pose_ns > 0 && (*frame)->made_from.landmarks_ns > 0 &&
           (*frame)->region_width_px > 0;
  }));
  expect_no_harm("near");
  expect_no_harm("far");
}

TEST_F(Bridge, WhatPeopleChangeOnTheNearComputerChangesOnTheFarOne) {
  const auto near = up_near();
  ASSERT_TRUE(eventually([&] {
    return about("near", {"set", "light.master=0.25", "content.left=builtin:checker"}).exit_code ==
           0;
  }));
  const auto far = up_far();  // which also gets what was changed before
  const auto far_has = [&](const std::string& setting, const std::string& value) {
    return eventually([&] {
      return about("far", {"get", setting}).output.find(value) != std::string::npos;
    });
  };
  EXPECT_TRUE(far_has("light.master", "= 0.25")) << about("far", {"get"}).output << far->log();
  EXPECT_TRUE(far_has("content.left", "builtin:checker"));
  EXPECT_EQ(about("near", {"set", "light.master"}).exit_code, 0);
  EXPECT_TRUE(far_has("light.master", "= 1")) << about("far", {"get"}).output;
}

TEST_F(Bridge, APartitionIsSaidAndItsEndTooAndTheNearLightGoesOn) {
  if (!is_connected()) GTEST_SKIP() << computers_->kWhyNot;
  const auto near = up_near();
  const auto far = up_far();
  ASSERT_TRUE(is_said(*far, "pose.hands comes from near@")) << far->log();
  ASSERT_TRUE(grows("far", "pose.hands"));
  computers_->connect(false);
  EXPECT_TRUE(is_said(*far, "pose.hands: near@")) << far->log();
  EXPECT_TRUE(grows("near", "projection.frames"));
  EXPECT_TRUE(grows("far", "projection.frames"));  // dark, but it runs
  usleep(12'000'000);                              // DDS has forgotten the other computer
  computers_->connect(true);
  EXPECT_TRUE(is_said(*far, "is back after")) << far->log();
  EXPECT_TRUE(grows("far", "pose.hands"));
  expect_no_harm("near");
  expect_no_harm("far");
}

TEST_F(Bridge, LossAndDelayCostMessagesAndNothingElse) {
  std::optional<Variable> lossy;
  const bool has_netem = computers_->disturb("delay 0ms");
  if (!has_netem) {
    std::fprintf(stderr, "this kernel has no netem: no delay; messages are lost in CycloneDDS\n");
    lossy.emplace("CYCLONEDDS_URI",
                  "<CycloneDDS><Domain id=\"any\"><Internal><Test><XmitLossiness>100"
                  "</XmitLossiness></Test></Internal></Domain></CycloneDDS>");
  }
  const auto near = up_near();
  const auto far = up_far();
  for (const auto* netem :
       {"delay 0ms loss 10%", "delay 20ms 5ms loss 10%", "delay 20ms loss 1%"}) {
    ASSERT_TRUE(!has_netem || computers_->disturb(netem));
    EXPECT_TRUE(grows("far", "pose.hands", 100)) << netem << far->log();
    EXPECT_TRUE(grows("far", "landmarks.hands")) << netem << far->log();
    EXPECT_TRUE(grows("near", "projection.frames")) << netem;
    if (!has_netem) break;
  }
  expect_no_harm("near");
  expect_no_harm("far");
}

TEST_F(Bridge, OfTwoSendersTheFirstIsUsedUntilItStops) {
  const auto far = up_far();
  const auto near = up_near("first");
  ASSERT_TRUE(is_said(*far, "pose.hands comes from first@")) << far->log();
  const auto second = up_near("second");
  ASSERT_TRUE(is_said(*far, "second@")) << far->log();
  EXPECT_THAT(far->log(), HasSubstr("was first and is used until it stops"));
  EXPECT_THAT(far->log(), Not(HasSubstr("comes from second@")));
  EXPECT_EQ(about("first", {"down"}).exit_code, 0);
  EXPECT_TRUE(is_said(*far, "pose.hands comes from second@")) << far->log();
  EXPECT_TRUE(grows("far", "pose.hands"));
}

TEST_F(Bridge, ADeadBridgeIsStartedAgainAndCostsTheNearComputerNothing) {
  const auto near = up_near();
  const auto far = up_far();
  ASSERT_TRUE(is_said(*far, "pose.hands comes from near@")) << far->log();
  const auto pid = status_of("near")["services"]["bridge"].value("pid", 0);
  ASSERT_GT(pid, 0);
  kill(pid, SIGKILL);
  EXPECT_TRUE(eventually([&] { return status_of("near")["services"]["bridge"]["restarts"] == 1; }));
  EXPECT_TRUE(grows("near", "projection.frames"));
  EXPECT_TRUE(grows("far", "pose.hands", 100)) << far->log();
  for (const auto& [name, service] : status_of("near")["services"].items())
    EXPECT_EQ(service["restarts"], name == "bridge" ? 1 : 0) << name;
}

TEST_F(Bridge, SettingsThatDoNotFitAreASentenceBeforeTheStart) {
  const auto log_of = [&](const Arguments& more) {
    Arguments words{"config", "config/rigs/twin.toml", "--check"};
    for (const auto& setting : more) words.insert(words.end(), {"--set", setting});
    const auto outcome = handcast(words);
    EXPECT_EQ(outcome.exit_code, 100);
    return outcome.output + outcome.log;
  };
  EXPECT_THAT(log_of({"bridge.send=['camera.frames']"}),
              HasSubstr("bridge.send: there is no stream 'camera.frames'"));
  EXPECT_THAT(log_of({"bridge.receive=['pose.hands']"}),
              HasSubstr("pose.hands is used only by pose.backend = \"external\""));
  EXPECT_THAT(log_of({"bridge.send=['pose.hands']", "bridge.peers=['a b']"}),
              HasSubstr("bridge.peers: 'a b' is neither a name nor an address"));
}

}  // namespace
}  // namespace handcast::system_test
