// SPDX-License-Identifier: Apache-2.0
// A program that is a rig's tracker and detector, by handcast.h.
#include <gmock/gmock.h>
#include <handcast.h>
#include <signal.h>

#include <atomic>
#include <cstring>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <thread>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/control/rig_address.hpp"
#include "services/lab/twin/twin.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A program that knows the twin's hands. It finds the start of the rig by the number and the time
/// of an image.
class KnowingProgram {
 public:
  /// `shift_m`: by which its hands are wrong, to the right.
  explicit KnowingProgram(float shift_m) : shift_m_(shift_m) {
    thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
  }
  int sent() const { return sent_; }

 private:
  void work(const std::stop_token& stop) {
    config::Rig settings;
    settings.twin.motion = "builtin:wave";
    settings.camera.rate_hz = 100;
    const auto twin = twin::Twin::create(settings, calib::reference_rig()).value();
    handcast_rig* rig = nullptr;
    if (handcast_rig_open("", &rig) != HANDCAST_OK) return;
    handcast_image image;
    while (!stop.stop_requested()) {
      if (handcast_wait_image(rig, &image, 100) != HANDCAST_OK) continue;
      const auto true_ns = twin->camera_origin_ns(image.number);
      send_hands(*rig, *twin, image, true_ns);
      send_landmarks(*rig, *twin, image, true_ns);
    }
    handcast_rig_close(rig);
  }

  void send_hands(handcast_rig& rig, const twin::Twin& twin, const handcast_image& image,
                  std::int64_t true_ns) {
    const auto joints = twin.joints(msg::Side::left, true_ns);
    if (!joints) return;
    handcast_both_hands hands{};
    hands.time_ns = image.time_ns;
    hands.is_there[HANDCAST_LEFT] = 1;
    for (std::size_t i = 0; i < joints->size(); ++i) {
      auto& joint = hands.joints[HANDCAST_LEFT][i];
      const auto& frame = (*joints)[i];
      const auto axes = glm::normalize(glm::quat_cast(glm::mat3(frame)));
      joint = {
          {frame[3].x + shift_m_, frame[3].y, frame[3].z}, {axes.x, axes.y, axes.z, axes.w}, 0.01f};
    }
    if (handcast_send_hands(&rig, &hands) == HANDCAST_OK) ++sent_;
  }

  static void send_landmarks(handcast_rig& rig, const twin::Twin& twin, const handcast_image& image,
                             std::int64_t true_ns) {
    const auto places_px = twin.landmarks(msg::Side::left, true_ns);
    if (!places_px) return;
    handcast_landmarks found{};
    found.image = image.number;
    found.time_ns = image.time_ns;
    found.presence[HANDCAST_LEFT] = 1;
    for (std::size_t i = 0; i < places_px->size(); ++i)
      found.points[HANDCAST_LEFT][i] = {(*places_px)[i].x, (*places_px)[i].y, 1, 1};
    handcast_send_landmarks(&rig, &found);
  }

  float shift_m_;
  std::atomic<int> sent_{0};
  std::jthread thread_;
};

class External : public SystemTest {
 protected:
  std::unique_ptr<Command> up_external(const Arguments& more = {}) const {
    Arguments arguments{"--set", "pose.backend=external",    "--set", "camera.rate_hz=100",
                        "--set", "twin.motion=builtin:wave", "--out", scratch_.path() / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return up(arguments);
  }
  /// The interior error (mean, mm) that the observer measures; negative as long as there is none.
  double scored_mm() const {
    std::ifstream file(scratch_.path() / "out/observer.json");
    const auto json = nlohmann::json::parse(file, nullptr, false);
    if (json.is_discarded() || !json["interior_mm"]["mean"].is_number()) return -1;
    return json["interior_mm"]["mean"];
  }
};

TEST_F(External, ATrackerAndDetectorThatAProgramIsAreScored) {
  const auto rig = up_external({"--set", "landmarks.backend=external"});
  wait_until_light();
  const Variable scope(control::kScopeVariable, scratch_.path().string());
  const KnowingProgram program(0);
  ASSERT_TRUE(eventually([&] { return scored_mm() >= 0; })) << rig->log();
  EXPECT_TRUE(eventually([&] { return scored_mm() < 8; })) << scored_mm();
  EXPECT_THAT(rig->log(), Not(HasSubstr("nothing is scored")));
}

TEST_F(External, WhatIsScoredIsWhatTheProgramSent) {
  const auto rig =
      up_external({"--set", "cascade.filter.method=none", "--set", "cascade.register.method=none"});
  wait_until_light();
  const Variable scope(control::kScopeVariable, scratch_.path().string());
  const KnowingProgram program(0.05f);
  EXPECT_TRUE(eventually([&] { return scored_mm() > 15; })) << scored_mm();
}

TEST_F(External, TheServiceLivesOnWithoutItsProgramAndTakesTheNextOne) {
  const auto rig = up_external();
  wait_until_light();
  const auto pid = service("pose")["pid"];
  const Variable scope(control::kScopeVariable, scratch_.path().string());
  for (int i = 0; i < 2; ++i) {
    const KnowingProgram program(0);
    EXPECT_TRUE(eventually([&] { return program.sent() > 20; })) << rig->log();
  }
  EXPECT_EQ(service("pose")["pid"], pid);
  EXPECT_EQ(service("pose")["state"], "ready");
  expect_more_light();
  EXPECT_TRUE(eventually(
      [&] { return rig->log().find("nothing was sent to guest.pose") != std::string::npos; }));
}

}  // namespace
}  // namespace handcast::system_test
