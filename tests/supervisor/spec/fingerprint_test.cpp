// SPDX-License-Identifier: Apache-2.0
#include "supervisor/spec/fingerprint.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "config/guests.hpp"
#include "config/settings/settings.hpp"
#include "tests/config/every_setting.hpp"
#include "tests/scratch.hpp"
#include "tests/supervisor/spec/built_catalogue.hpp"

namespace handcast::supervisor {
namespace {

using testing::UnorderedElementsAreArray;
using Paths = std::set<std::string>;

const std::vector<std::string> kServices{"camera", "pose",     "landmarks", "projector", "content",
                                         "desk",   "observer", "exporter",  "watch",     "bridge"};

/// What the programs of this build say about themselves.
const Catalogue& built() {
  static const Catalogue kCatalogue = test::built_catalogue();
  return kCatalogue;
}

/// Every setting of the sections named, and the settings named.
Paths settings_in(const std::vector<std::string>& names) {
  config::Rig rig;
  Paths paths;
  for (const auto& section : config::list_settings(rig))
    for (const auto& setting : section.settings)
      for (const auto& name : names)
        if (setting.path == name || setting.path.starts_with(name + "."))
          paths.insert(setting.path);
  return paths;
}

Paths without(Paths paths, const Paths& others) {
  for (const auto& other : others) paths.erase(other);
  return paths;
}

/// The settings that change the service's fingerprint when they change, one at a time.
Paths read_by(const std::string& service, const config::Rig& rig) {
  Paths paths;
  const auto before = fingerprint_of(service, rig, built());
  auto listed = rig;
  for (const auto& section : config::list_settings(listed)) {
    for (const auto& setting : section.settings) {
      auto changed = rig;
      const auto listing = config::list_settings(changed);
      config::change(*config::find_setting(listing, setting.path));
      if (fingerprint_of(service, changed, built()) != before) paths.insert(setting.path);
    }
  }
  return paths;
}

config::Rig replay() {
  config::Rig rig;
  rig.camera.backend = rig.pose.backend = rig.landmarks.backend = "replay";
  return rig;
}

config::Rig networks() {
  config::Rig rig;
  rig.landmarks.backend = "mediapipe";
  return rig;
}

void expect_reads(const std::string& service, const config::Rig& rig,
                  const std::vector<std::string>& names, const Paths& not_these = {}) {
  auto all = names;
  all.insert(all.end(), {"calibration"});
  std::vector<std::string> of_guests;
  for (const auto& guest : config::kGuests) of_guests.push_back(guest.section());
  const auto wanted = without(without(settings_in(all), not_these), settings_in(of_guests));
  EXPECT_THAT(read_by(service, rig), UnorderedElementsAreArray(wanted)) << service;
}

const std::vector<std::string> kTruth{"twin.motion", "twin.hands",    "twin.speed", "twin.seed",
                                      "twin.shape",  "twin.geometry", "twin.prop",  "hand"};

std::vector<std::string> truth_and(std::vector<std::string> more) {
  more.insert(more.end(), kTruth.begin(), kTruth.end());
  return more;
}

TEST(Fingerprint, ATwinRigsServicesDependOnTheirOwnSettingsAndOnWhatTheTwinMakesOfThem) {
  const config::Rig rig;
  expect_reads("camera", rig, truth_and({"camera", "twin.image"}),
               settings_in({"camera.aravis", "camera.v4l2", "camera.leap", "camera.delivery_ms",
                            "camera.replay", "camera.process.standby"}));
  expect_reads("pose", rig, truth_and({"pose", "twin.tracker"}),
               settings_in({"pose.replay", "pose.none", "pose.leapc", "pose.openxr", "pose.stereo",
                            "pose.process.standby"}));
  expect_reads("landmarks", rig,
               truth_and({"landmarks", "twin.detector", "twin.image.delivery_ms", "twin.image.lost",
                          "twin.image.burst", "twin.image.clock_drift_ppm",
                          "twin.image.clock_jitter_ms", "camera.rate_hz", "camera.exposure_ms"}),
               settings_in({"landmarks.replay", "landmarks.models", "landmarks.hands",
                            "landmarks.process.standby"}));
}

TEST(Fingerprint, ADetectorOfNetworksDependsOnItsModelsAndNotOnTheTwin) {
  expect_reads("landmarks", networks(), {"landmarks", "pose.backend"},
               settings_in({"landmarks.replay", "landmarks.process.standby"}));
  config::Rig handcast;
  handcast.landmarks.backend = "handcast";
  expect_reads("landmarks", handcast, {"landmarks", "pose.backend"},
               settings_in({"landmarks.replay", "landmarks.process.standby"}));
}

TEST(Fingerprint, ADetectorDependsOnWhatItsFallbackReads) {
  auto rig = networks();
  rig.landmarks.fallback = "twin";
  expect_reads("landmarks", rig,
               truth_and({"landmarks", "pose.backend", "twin.detector", "twin.image.delivery_ms",
                          "twin.image.lost", "twin.image.burst", "twin.image.clock_drift_ppm",
                          "twin.image.clock_jitter_ms", "camera.rate_hz", "camera.exposure_ms"}),
               settings_in({"landmarks.replay", "landmarks.process.standby"}));
}

TEST(Fingerprint, AReplayedRigsServicesDoNotDependOnTheTwin) {
  expect_reads("camera", replay(), {"camera"},
               settings_in({"camera.aravis", "camera.v4l2", "camera.leap", "camera.delivery_ms",
                            "camera.process.standby"}));
  expect_reads("pose", replay(), {"pose"},
               settings_in({"pose.none", "pose.leapc", "pose.openxr", "pose.stereo",
                            "pose.process.standby"}));
  expect_reads("landmarks", replay(), {"landmarks"},
               settings_in({"landmarks.models", "landmarks.hands", "landmarks.process.standby"}));
}

config::Rig with_camera(const char* backend) {
  config::Rig rig;
  rig.camera.backend = backend;
  rig.pose.backend = "none";
  return rig;
}

config::Rig with_second_tracker(const char* backend) {
  config::Rig rig;
  rig.pose.second = backend;
  return rig;
}

TEST(Fingerprint, ASecondTrackerAddsWhatItReads) {
  expect_reads("pose", with_second_tracker("leapc"), truth_and({"pose", "twin.tracker"}),
               settings_in({"pose.replay", "pose.none", "pose.openxr", "pose.stereo",
                            "pose.process.standby"}));
}

TEST(Fingerprint, ARealCameraDependsOnItsOwnSection) {
  expect_reads(
      "camera", with_camera("v4l2"), {"camera"},
      settings_in({"camera.aravis", "camera.leap", "camera.replay", "camera.process.standby"}));
  if (std::ranges::none_of(built().at("camera").backends,
                           [](const auto& backend) { return backend.name == "aravis"; }))
    GTEST_SKIP() << "this build has no Aravis";
  expect_reads(
      "camera", with_camera("aravis"), {"camera"},
      settings_in({"camera.v4l2", "camera.leap", "camera.replay", "camera.process.standby"}));
}

TEST(Fingerprint, TheProjectorDependsOnTheCascadeAndWhatIsDrawnAndNotOnTheTwin) {
  expect_reads("projector", {},
               {"projector", "projector2.backend", "projector2.calibration", "light",
                "content.shading", "content.smooth", "hand", "cascade"},
               {"projector.process.standby"});
}

TEST(Fingerprint, ContentDependsOnItsSectionAndOnWhatPredictsTheHandsThatItReactsTo) {
  expect_reads("content", {}, {"content", "hand", "cascade.predict", "cascade.skin"},
               {"content.process.standby"});
}

TEST(Fingerprint, TheDeskDependsOnAllThatItLetsPeopleChange) {
  expect_reads("desk", {},
               {"desk",
                "light",
                "hand",
                "cascade",
                "twin.tracker",
                "twin.detector",
                "twin.image",
                "projector.lamp",
                "projector.frame_wait_ms",
                "projector.brightness",
                "projector.gamma",
                "projector.fade_s",
                "projector2.frame_wait_ms",
                "projector2.brightness",
                "projector2.gamma",
                "projector2.fade_s",
                "content.left",
                "content.right",
                "content.transition",
                "content.transition_s",
                "content.shading",
                "content.gravity"},
               {"desk.process.standby", "cascade.mask.forearm_mm", "twin.tracker.rate_hz"});
}

TEST(Fingerprint, TheObserverDependsOnTheTruthAndOnWhereItComesFrom) {
  expect_reads("observer", {}, truth_and({"observer", "camera.backend"}),
               {"observer.enabled", "observer.process.standby"});
}

TEST(Fingerprint, TheNightWatchDependsOnItsSectionAndOnWhetherThereIsALamp) {
  expect_reads("watch", {}, {"watch", "projector.lamp"},
               {"watch.enabled", "watch.process.standby"});
}

TEST(Fingerprint, TheBridgeDependsOnItsSection) {
  if (!built().contains("bridge")) GTEST_SKIP() << "this build has no bridge";
  expect_reads("bridge", {}, {"bridge"}, {"bridge.process.standby"});
}

TEST(Fingerprint, TheExporterDependsOnItsPortAndOnWhatEveryServiceReads) {
  if (!built().contains("exporter")) GTEST_SKIP() << "this build has no exporter";
  expect_reads("exporter", {}, {"supervisor.metrics_port"});
}

config::Rig commanded() {
  config::Rig rig;
  rig.dlp.backend = "lightcrafter";
  return rig;
}

TEST(Fingerprint, ACommandedProjectorDependsOnItsSectionAndTheRateOfThePatterns) {
  if (!built().contains("dlp")) GTEST_SKIP() << "this build has no dlp";
  auto expected = settings_in({"dlp", "projector.packing", "projector.rate_hz", "calibration"});
  EXPECT_THAT(read_by("dlp", commanded()),
              UnorderedElementsAreArray(without(expected, {"dlp.process.standby"})));
}

TEST(Fingerprint, WhatOnlyTheSupervisorReadsIsInNone) {
  for (const auto& service : kServices) {
    const auto paths = read_by(service, {});
    if (service == "exporter" && !built().contains(service)) continue;
    for (const auto* path : {"name", "supervisor.ready_s", "supervisor.stop_s",
                             "supervisor.silent_s", "supervisor.history_s"})
      EXPECT_FALSE(paths.contains(path)) << service << " " << path;
  }
}

/// A rig of two cameras, whose second one and its detector have these back ends.
config::Rig pair(const std::string& camera2, const std::string& landmarks2) {
  config::Rig rig;
  rig.camera2.backend = camera2;
  rig.landmarks2.backend = landmarks2;
  rig.pose.backend = "stereo";
  return rig;
}

TEST(Fingerprint, TheServicesOfTheSecondViewDependOnItsSectionsAndNotOnTheFirsts) {
  expect_reads("camera2", pair("replay", "replay"), {"camera2"},
               settings_in({"camera2.aravis", "camera2.v4l2", "camera2.leap", "camera2.delivery_ms",
                            "camera2.process.standby"}));
  expect_reads("landmarks2", pair("replay", "handcast"), {"landmarks2", "pose.backend"},
               settings_in({"landmarks2.replay", "landmarks2.process.standby"}));
  expect_reads("pose", pair("replay", "replay"),
               {"pose", "hand", "camera.backend", "camera2.backend"},
               settings_in({"pose.none", "pose.replay", "pose.leapc", "pose.openxr",
                            "pose.process.standby"}));
}

TEST(Fingerprint, AProgramOfSomebodyDependsOnItsSectionAndOnTheProcessThatItIsPartOf) {
  for (const auto& guest : config::kGuests) {
    auto expected =
        settings_in({guest.section(), std::string(guest.feeds) + ".process", "calibration"});
    expected.erase(std::string(guest.feeds) + ".process.standby");
    EXPECT_THAT(read_by(std::string(guest.service), {}), UnorderedElementsAreArray(expected));
  }
}

TEST(Fingerprint, EverySettingOfTheRigIsInAFingerprintOrTheSupervisorsOwn) {
  Paths read;
  for (const auto& service : kServices) {
    read.merge(read_by(service, {}));
    read.merge(read_by(service, replay()));
    read.merge(read_by(service, networks()));
    read.merge(read_by(service, with_camera("aravis")));
    read.merge(read_by(service, with_camera("v4l2")));
    read.merge(read_by(service, with_camera("leap")));
    read.merge(read_by(service, with_second_tracker("leapc")));
    read.merge(read_by(service, with_second_tracker("openxr")));
  }
  read.merge(read_by("pose", pair("twin", "twin")));
  for (const auto& guest : config::kGuests) read.merge(read_by(std::string(guest.service), {}));
  for (const auto* camera2 : {"twin", "replay", "aravis", "v4l2", "leap"})
    read.merge(read_by("camera2", pair(camera2, "twin")));
  for (const auto* landmarks2 : {"twin", "replay", "mediapipe"})
    read.merge(read_by("landmarks2", pair("twin", landmarks2)));
  read.merge(read_by("dlp", commanded()));
  config::Rig rig;
  rig.projector2.backend = "twin";
  read.merge(read_by("projector2", rig));
  for (const auto& section : config::list_settings(rig)) {
    for (const auto& setting : section.settings) {
      const auto& path = setting.path;
      const bool supervisors = path == "name" || path == "observer.enabled" ||
                               path == "watch.enabled" || path.starts_with("supervisor.") ||
                               path.ends_with(".standby");
      const bool exporters = path == "supervisor.metrics_port" && built().contains("exporter");
      const bool simulators = path.starts_with("twin.projector.");
      EXPECT_EQ(read.contains(path), !(supervisors || simulators) || exporters) << path;
    }
  }
}

TEST(Fingerprint, ABackEndThatNobodyThoughtOfDependsOnAllButTheSupervisorsSettings) {
  config::Rig rig;
  rig.camera.backend = "a_camera_of_tomorrow";
  const auto paths = read_by("camera", rig);
  for (const auto* path :
       {"camera.rate_hz", "camera.replay.directory", "cascade.fill.method", "twin.tracker.age_ms"})
    EXPECT_TRUE(paths.contains(path)) << path;
  EXPECT_FALSE(paths.contains("supervisor.ready_s"));
  EXPECT_TRUE(read_by("sound", {}).contains("content.left"));  // a service of another year
}

TEST(Fingerprint, AFileThatChangedUnderItsNameIsAChange) {
  const test::Scratch scratch;
  config::Rig rig;
  rig.calibration = scratch.path() / "calibration.toml";
  std::ofstream(rig.calibration) << "width_px = 720\n";
  const auto before = fingerprint_of("pose", rig, built());
  EXPECT_EQ(fingerprint_of("pose", rig, built()), before);
  std::ofstream(rig.calibration) << "width_px = 721\n";
  EXPECT_NE(fingerprint_of("pose", rig, built()), before);
}

TEST(Fingerprint, ALargeFileCountsByItsSizeAndTime) {
  const test::Scratch scratch;
  config::Rig rig;
  const auto film = scratch.path() / "film.mp4";
  rig.content.left = film;
  const auto now = [&] { return fingerprint_of("content", rig, built()); };
  std::ofstream(film) << "short";
  const auto shorter = now();
  std::filesystem::resize_file(film, std::uintmax_t{1} << 40);  // nobody can read so much
  const auto before = now();
  EXPECT_NE(before, shorter);
  EXPECT_EQ(now(), before);
  std::filesystem::last_write_time(
      film, std::filesystem::last_write_time(film) + std::chrono::seconds(1));
  EXPECT_NE(now(), before);
}

TEST(Fingerprint, WithAnotherBackEndItIsThatOfARigThatAsksForIt) {
  EXPECT_EQ(backend_of("pose", with_backend({}, "pose", "replay")), "replay");
  EXPECT_EQ(backend_of("observer", {}), "");
  EXPECT_NE(fingerprint_of("pose", with_backend({}, "pose", "replay"), built()),
            fingerprint_of("pose", {}, built()));
}

}  // namespace
}  // namespace handcast::supervisor
