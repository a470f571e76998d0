// SPDX-License-Identifier: Apache-2.0
// Settings that people change while the light is on, in a rig.
#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

/// A rig whose light is looked at.
class RigWithDesk : public SystemTest {
 protected:
  /// Whether the next frames with a hand have light.
  bool is_dark() const {
    const Variable scope(control::kScopeVariable, scratch_.path().string());
    auto frames = client::open_stream<msg::Projection>("twin", "projection.frames");
    if (!frames) return false;
    int dark = 0;
    for (int seen = 0; seen < 5; ++seen) {
      const auto frame = frames->latest(Deadline::in(5s));
      if (!frame) return false;
      const std::size_t count = std::size_t{(*frame)->region_width_px} * (*frame)->region_height_px;
      dark += std::all_of((*frame)->pixels(), (*frame)->pixels() + count,
                          [](auto pixel) { return (pixel & 0xffffff) == 0; });
    }
    return dark == 5;
  }
  std::string changed() const { return handcast({"get", "--changed"}).output; }
  void kill_and_wait(const std::string& name) const {
    const auto victim = service(name)["pid"].get<pid_t>();
    kill(victim, SIGKILL);
    EXPECT_TRUE(eventually([&] {
      const auto now = service(name);
      return now["pid"] != victim && now["state"] == "ready";
    })) << name;
  }
};

constexpr const char* kEverywhere = "light.keep_out=-10 -10, 5000 -10, 5000 5000, -10 5000";

TEST_F(RigWithDesk, ChangesAreSeenAndOutliveTheProcessesThatReadThem) {
  const auto rig = up({"--set", "twin.motion=builtin:still"});
  wait_until_light();
  EXPECT_FALSE(is_dark());
  ASSERT_EQ(handcast({"set", kEverywhere}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return is_dark(); }));
  kill_and_wait("projector");
  EXPECT_TRUE(eventually([&] { return is_dark(); }));
  EXPECT_EQ(handcast({"restart", "projector"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return is_dark(); }));
  ASSERT_EQ(handcast({"undo"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return !is_dark(); }));
  EXPECT_EQ(changed(), "");
}

TEST_F(RigWithDesk, TheErrorsOfTheTwinsSensorsAreTurnedInEachService) {
  const auto rig = up({"--set", "twin.motion=builtin:still", "--set", "landmarks.backend=twin"});
  wait_until_light();
  const Variable scope(control::kScopeVariable, scratch_.path().string());
  auto poses = client::open_stream<msg::HandPoses>("twin", "pose.hands");
  auto landmarks = client::open_stream<msg::Landmarks>("twin", "landmarks.hands");
  auto frames = client::open_stream<msg::CameraFrame>("twin", "camera.frames");
  ASSERT_TRUE(poses && landmarks && frames);
  const auto hands_in = [](auto& stream) {
    const auto next = stream.latest(Deadline::in(5s));
    return next ? static_cast<int>((*next)->count) : -1;
  };
  EXPECT_TRUE(eventually([&] { return hands_in(*poses) > 0 && hands_in(*landmarks) > 0; }));
  ASSERT_EQ(handcast({"set", "twin.tracker.dropout=1", "twin.detector.dropout=1"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return hands_in(*poses) == 0 && hands_in(*landmarks) == 0; }));
  ASSERT_EQ(handcast({"set", "twin.tracker.dropout", "twin.image.lost=1"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return hands_in(*poses) > 0; }));
  EXPECT_TRUE(eventually([&] { return !frames->latest(Deadline::in(500ms)).has_value(); }));
  ASSERT_EQ(handcast({"undo"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return frames->latest(Deadline::in(500ms)).has_value(); }));
  EXPECT_THAT(handcast({"set", "twin.tracker.rate_hz=50"}).log, HasSubstr("handcast reload"));
}

TEST_F(RigWithDesk, ABadChangeIsRefusedWithItsReasonAndChangesNothing) {
  const auto rig = up();
  wait_until_light();
  const auto refused = handcast({"set", "light.freeze=true", "light.master=2"});
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_THAT(refused.log, HasSubstr("2 is outside 0..1"));
  EXPECT_THAT(handcast({"set", "camera.rate_hz=100"}).log, HasSubstr("handcast reload"));
  EXPECT_EQ(changed(), "");
}

TEST_F(RigWithDesk, TheDeskServesItsPageAndMayDie) {
  const auto rig = up();
  wait_until_light();
  const auto first = handcast({"desk"});
  EXPECT_EQ(first.exit_code, 0) << first.log;
  EXPECT_THAT(first.output, HasSubstr("http://127.0.0.1:"));
  const auto lit = light();
  kill_and_wait("desk");
  EXPECT_GT(light(), lit);
  EXPECT_THAT(handcast({"desk"}).output, HasSubstr(last_line(first.output).substr(30)))
      << "a page that is open goes on";
}

TEST_F(RigWithDesk, OtherComputersGetAnAddressAndACodeIfTheRigFileSaysSo) {
  {
    const auto rig = up();
    wait_until_light();
    const auto refused = handcast({"desk", "--lan"});
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_THAT(refused.log, HasSubstr("desk.page.lan = \"0.0.0.0:8481\""));
    EXPECT_EQ(handcast({"down"}).exit_code, 0);
  }
  const auto rig = up({"--set", "desk.page.lan=127.0.0.1:0"});
  wait_until_light();
  Outcome answer;
  EXPECT_TRUE(eventually([&] {
    answer = handcast({"desk", "--lan", "--for", "operator"});
    return answer.exit_code == 0;
  })) << answer.log;
  const auto first = answer.output;
  EXPECT_THAT(first, testing::StartsWith("https://127.0.0.1:"));
  EXPECT_THAT(first,
              testing::ContainsRegex("code [0-9]{4} [0-9]{4}: makes a browser the operator"));
  EXPECT_THAT(first, testing::ContainsRegex("\n([0-9A-F]{2}:){9}[0-9A-F]{2}\n"));
  const auto second = handcast({"desk", "--lan", "--for", "operator"}).output;
  EXPECT_NE(first, second) << "another code";
  EXPECT_EQ(last_line(first), last_line(second)) << "the same certificate";
}

TEST_F(RigWithDesk, BlackoutAndMasterAreOneWord) {
  const auto rig = up();
  wait_until_light();
  EXPECT_EQ(handcast({"blackout"}).exit_code, 0);
  EXPECT_THAT(changed(), HasSubstr("light.blackout = true"));
  EXPECT_EQ(handcast({"blackout", "off"}).exit_code, 0);
  EXPECT_EQ(handcast({"master", "0.5", "--seconds", "2"}).exit_code, 0);
  EXPECT_THAT(changed(), HasSubstr("light.master = 0.5"));
  EXPECT_THAT(changed(), Not(HasSubstr("blackout")));
  EXPECT_THAT(handcast({"freeze", "maybe"}).log, HasSubstr("write on or off"));
  EXPECT_THAT(handcast({"preset", "--store"}).log, HasSubstr("--store needs a NAME"));
}

}  // namespace
}  // namespace handcast::system_test
