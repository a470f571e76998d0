// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <filesystem>

#include "supervisor/spec/fingerprint.hpp"
#include "tests/supervisor/spec/built_catalogue.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> idle_in(const std::string& toml,
                                 const std::vector<std::string>& settings = {}) {
  const auto rig = config::parse_rig(toml, "/nowhere/rig.toml", settings);
  EXPECT_TRUE(rig) << rig.error().what;
  return idle_settings(*rig, test::built_catalogue(), settings);
}

TEST(IdleSettings, NamesWhatBelongsToAnotherBackEnd) {
  EXPECT_THAT(idle_in("camera.backend = 'v4l2'\ncamera.aravis.device = 'A-1'\n"
                      "camera.aravis.gain_db = 3\ncamera.v4l2.device = '/dev/video0'\n"),
              ElementsAre("camera.aravis.device, camera.aravis.gain_db have no effect, because "
                          "camera.backend is \"v4l2\""));
  EXPECT_THAT(idle_in("projector.backend = 'file'\nprojector.window.monitor = 'HDMI-1'\n"),
              ElementsAre("projector.window.monitor has no effect, because projector.backend is "
                          "\"file\""));
  EXPECT_THAT(idle_in("pose.backend = 'none'\npose.openxr.age_ms = 5\n"),
              ElementsAre("pose.openxr.age_ms has no effect, because pose.backend is \"none\""));
  EXPECT_THAT(idle_in("camera.delivery_ms = 3\n"),
              ElementsAre("camera.delivery_ms has no effect, because camera.backend is \"twin\""));
}

TEST(IdleSettings, NamesWhatBelongsToAServiceThatTheRigDoesNotHave) {
  EXPECT_THAT(idle_in("dlp.red = 0.01\ncamera2.rate_hz = 30\nlandmarks2.hands = 1\n"
                      "pose.handover.return_ms = 333\n"),
              testing::UnorderedElementsAre(
                  "camera2.rate_hz has no effect, because camera2.backend is \"none\"",
                  "dlp.red has no effect, because dlp.backend is \"none\"",
                  "landmarks2.hands has no effect, because the rig has no second camera",
                  "pose.handover.return_ms has no effect, because pose.second is empty"));
}

TEST(IdleSettings, IsSilentAboutWhatIsRead) {
  EXPECT_THAT(idle_in(""), IsEmpty());
  EXPECT_THAT(idle_in("camera.backend = 'v4l2'\ncamera.v4l2.device = 'a'\ncamera.delivery_ms = 9\n"
                      "projector.brightness = 0.5\nprojector.backend = 'file'\n"
                      "projector.file.film = true\nlandmarks.backend = 'handcast'\n"
                      "landmarks.hands = 1\nhand.left = 'a.glb'\ncamera.process.priority = 5\n"),
              IsEmpty());
  EXPECT_THAT(idle_in("pose.backend = 'leapc'\npose.second = 'openxr'\npose.openxr.age_ms = 5\n"),
              IsEmpty())
      << "a second source";
  EXPECT_THAT(idle_in("twin.tracker.rate_hz = 90\npose.backend = 'none'\n"), IsEmpty())
      << "the simulator reads it";
  EXPECT_THAT(idle_in("camera.v4l2.format = 'auto'\n"), IsEmpty()) << "a default says nothing";
}

TEST(IdleSettings, ABackEndThatIsTriedForOnceLeavesTheFileInPeace) {
  const std::string file = "camera.backend = 'v4l2'\ncamera.v4l2.device = '/dev/video0'\n";
  EXPECT_THAT(idle_in(file, {"camera.backend=twin"}), IsEmpty());
  EXPECT_THAT(idle_in(file, {"camera.aravis.device=A-1"}),
              ElementsAre("camera.aravis.device has no effect, because camera.backend is "
                          "\"v4l2\""));
}

TEST(IdleSettings, TheShippedRigsHaveNone) {
  for (const auto& entry : std::filesystem::directory_iterator("config/rigs")) {
    if (entry.path().extension() != ".toml") continue;
    const auto rig = config::load_rig(entry.path());
    ASSERT_TRUE(rig) << rig.error().what;
    EXPECT_THAT(idle_settings(*rig, test::built_catalogue(), {}), IsEmpty()) << entry.path();
  }
}

}  // namespace
}  // namespace handcast::supervisor
