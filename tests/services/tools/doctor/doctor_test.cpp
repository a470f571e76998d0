// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "services/tools/doctor/devices.hpp"
#include "services/tools/doctor/display.hpp"
#include "services/tools/doctor/live.hpp"
#include "services/tools/doctor/machine.hpp"
#include "services/tools/doctor/real_time.hpp"
#include "services/tools/doctor/rig_file.hpp"
#include "services/tools/doctor/start_check.hpp"
#include "services/tools/doctor/tracker.hpp"
#include "tests/scratch.hpp"
#ifdef HANDCAST_TEST_RUNTIME_MANIFEST
#include "tests/services/pose/openxr/scripted_runtime.hpp"
#endif

namespace handcast::doctor {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The finding of a check; a good one without a sentence if there is none.
Finding finding_of(const std::vector<Finding>& findings, const std::string& check) {
  for (const auto& finding : findings)
    if (finding.check == check) return finding;
  return {};
}

/// A folder that looks like the root of a computer.
class Computer : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((scratch_.path() / file).parent_path());
    std::ofstream(scratch_.path() / file) << text << '\n';
  }
  Finding finding(const std::string& check) const {
    return finding_of(examine_machine(rig_, scratch_.path()), check);
  }

  test::Scratch scratch_;
  config::Rig rig_;
};

TEST_F(Computer, AGovernorThatSavesPowerIsNamedWithTheCommandThatEndsIt) {
  EXPECT_EQ(finding("cpu governor").grade, Grade::good) << "a computer without governors";
  write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  EXPECT_EQ(finding("cpu governor").grade, Grade::good);
  write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave");
  EXPECT_EQ(finding("cpu governor").grade, Grade::advice);
  EXPECT_THAT(finding("cpu governor").sentence, HasSubstr("powersave"));
  EXPECT_THAT(finding("cpu governor").remedy, HasSubstr("cpupower"));
}

TEST(RealTime, IsTriedForEachServiceThatWantsIt) {
  config::Rig rig;
  EXPECT_EQ(examine_real_time(rig, [](auto&&...) { return ""; }).grade, Grade::advice);
  rig.camera.process.priority = 50;
  rig.projector.process.priority = 30;
  const auto may = [](const std::string& service, int priority) -> std::string {
    return service == "camera" && priority == 50 ? "Operation not permitted" : "";
  };
  const auto denied = examine_real_time(rig, may);
  EXPECT_EQ(denied.grade, Grade::fault);
  EXPECT_THAT(denied.sentence, HasSubstr("camera 50 (Operation not permitted)"));
  EXPECT_THAT(denied.sentence, Not(HasSubstr("projector")));
  EXPECT_NE(denied.remedy, "");
  rig.camera.process.priority = 0;
  rig.projector2.process.priority = 20;
  EXPECT_EQ(examine_real_time(rig, may).grade, Grade::good);
  EXPECT_THAT(examine_real_time(rig, may).sentence, HasSubstr("projector 30, projector2 20"));
}

TEST_F(Computer, WhatWouldBlankLockOrSuspendIsNamedForAWindow) {
  const auto found = [&](const std::string& check) {
    return finding_of(examine_display(rig_, scratch_.path()), check);
  };
  EXPECT_EQ(found("idle").sentence, "") << "no window";
  rig_.projector.backend = "window";
  EXPECT_EQ(found("idle").grade, Grade::good);
  EXPECT_EQ(found("suspend").grade, Grade::good);
  write("proc/17/comm", "xscreensaver");
  EXPECT_THAT(found("idle").sentence, HasSubstr("xscreensaver"));
  write("etc/systemd/logind.conf", "[Login]\n#IdleAction=lock\nIdleAction=suspend");
  EXPECT_THAT(found("suspend").sentence, HasSubstr("'suspend'"));
  write("etc/systemd/logind.conf.d/handcast.conf", "IdleAction=ignore");
  EXPECT_EQ(found("suspend").grade, Grade::good);
  write("proc/acpi/button/lid/LID/state", "open");
  EXPECT_THAT(found("suspend").sentence, HasSubstr("lid"));
}

TEST_F(Computer, TheNetworkIsExaminedOnlyForACameraThatMayUseIt) {
  EXPECT_EQ(finding("socket buffers").sentence, "");
  rig_.camera.backend = "aravis";
  write("proc/sys/net/core/rmem_max", "212992");
  write("sys/class/net/eth0/mtu", "1500");
  write("sys/class/net/lo/mtu", "65536");
  EXPECT_EQ(finding("socket buffers").grade, Grade::advice);
  EXPECT_THAT(finding("packet size").remedy, HasSubstr("eth0 mtu 9000"));
  write("proc/sys/net/core/rmem_max", "8000000");
  write("sys/class/net/eth1/mtu", "9000");
  EXPECT_EQ(finding("socket buffers").grade, Grade::good);
  EXPECT_EQ(finding("packet size").grade, Grade::good);
}

TEST_F(Computer, AFileOfNonsenseIsNotANumber) {
  rig_.camera.backend = "aravis";
  write("proc/sys/net/core/rmem_max", "a lot");
  EXPECT_EQ(finding("socket buffers").grade, Grade::advice);
}

TEST_F(Computer, TheRulesForUsbDevicesAreLookedForIfTheRigHasOne) {
  EXPECT_EQ(finding("udev rules").sentence, "");
  rig_.dlp.backend = "lightcrafter";
  EXPECT_EQ(finding("udev rules").remedy, "scripts/setup --udev");
  write("etc/udev/rules.d/70-handcast.rules", "");
  EXPECT_EQ(finding("udev rules").grade, Grade::good);
}

TEST_F(Computer, TheSoftwareAndTheDeviceOfUltraleapAreLookedFor) {
  const auto tracker = [this](const char* check) {
    return finding_of(examine_tracker(rig_, Asking::now, scratch_.path()), check);
  };
  EXPECT_EQ(tracker("tracker software").sentence, "") << "the twin's tracker needs none";
  rig_.pose.backend = "leapc";
  EXPECT_EQ(tracker("tracker software").grade, Grade::fault);
  EXPECT_THAT(tracker("tracker software").remedy, HasSubstr("install Ultraleap's"));
  EXPECT_EQ(tracker("tracker device").grade, Grade::fault);
  write("usr/lib/ultraleap-hand-tracking-service/libLeapC.so.5", "");
  write("sys/bus/usb/devices/1-4/idVendor", "f182");
  write("sys/bus/usb/devices/1-4/idProduct", "0003");
  EXPECT_EQ(tracker("tracker software").grade, Grade::good);
  EXPECT_EQ(tracker("tracker device").sentence, "Leap Motion Controller (f182:0003) at USB 1-4");
}

TEST_F(Computer, TheSecondTrackerIsLookedForToo) {
  rig_.pose.backend = "none";
  rig_.pose.second = "leapc";
  const auto findings = examine_tracker(rig_, Asking::now, scratch_.path());
  EXPECT_EQ(finding_of(findings, "tracker device").grade, Grade::fault);
}

TEST(Devices, ACameraThatIsNotAttachedIsAFaultThatSaysWhatIsThere) {
  config::Rig rig;
  rig.camera.backend = "v4l2";
  rig.camera.v4l2.device = "/dev/video99";
  rig.camera2 = rig.camera;
  for (const auto asking : {Asking::now, Asking::not_now})
    for (const auto* check : {"camera device", "camera2 device"}) {
      const auto finding = finding_of(examine_devices(rig, asking), check);
      EXPECT_EQ(finding.grade, Grade::fault);
      EXPECT_EQ(finding.sentence, "there is no camera '/dev/video99'");
      EXPECT_THAT(finding.remedy, HasSubstr("`handcast up` waits for it; "));
      EXPECT_THAT(finding.remedy, HasSubstr("attached"));
    }
}

TEST(Devices, EveryBackEndWithADeviceIsLookedFor) {
  for (const auto* backend : {"aravis", "v4l2", "leap"}) {
    config::Rig rig;
    rig.camera.backend = backend;
    rig.camera.aravis.device = rig.camera.leap.device = "nobody";
    rig.camera.v4l2.device = "nobody";
    const auto findings = examine_devices(rig, Asking::now);
    ASSERT_EQ(findings.size(), 1u) << backend;
    EXPECT_EQ(findings[0].grade, Grade::fault) << backend;
  }
  config::Rig rig;
  EXPECT_TRUE(examine_devices(rig, Asking::now).empty()) << "the twin has none";
  rig.dlp.backend = "lightcrafter";
  rig.dlp.device = "nobody";
  EXPECT_EQ(finding_of(examine_devices(rig, Asking::now), "dlp device").grade, Grade::fault);
}

TEST(Devices, WhatIsAttachedInsteadIsNamedWithItsBackEnd) {
  const std::vector<devices::Attached> attached{
      {.kind = devices::Kind::camera,
       .name = "'HD Webcam' (/dev/video0)",
       .about = {},
       .settings = {{"camera.backend", "v4l2"}, {"camera.v4l2.device", "/dev/video0"}},
       .names = {"HD Webcam"}},
      {.kind = devices::Kind::camera,  // a file that cannot be loaded
       .name = "camera 'mine'",
       .about = {},
       .settings = {{"camera.backend", "mine"}}}};
  EXPECT_EQ(instead_of_missing(devices::Kind::camera, attached),
            "attached: 'HD Webcam' (/dev/video0) (camera.backend = \"v4l2\")");
  EXPECT_EQ(instead_of_missing(devices::Kind::controller, attached), "no controller is attached");
}

TEST_F(Computer, ARuntimeThatIsNotThereIsAFaultWithARemedy) {
  rig_.pose.backend = "openxr";
  rig_.pose.openxr.runtime = "/nowhere/runtime.json";
  const auto findings = examine_tracker(rig_, Asking::now);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].grade, Grade::fault);
  EXPECT_THAT(findings[0].sentence, HasSubstr("/nowhere/runtime.json"));
  EXPECT_THAT(findings[0].remedy, HasSubstr("install a runtime"));
}

#ifdef HANDCAST_TEST_RUNTIME_MANIFEST
TEST_F(Computer, ARuntimeIsAskedUnlessTheRigIsUsingIt) {
  rig_.pose.backend = "openxr";
  rig_.pose.openxr.runtime = HANDCAST_TEST_RUNTIME_MANIFEST;
  const auto asked = examine_tracker(rig_, Asking::now);
  EXPECT_FALSE(has_fault(asked));
  EXPECT_EQ(finding_of(asked, "tracker service").sentence,
            "Test Runtime 0.1.2, 'Test Tracker' answers");
  EXPECT_EQ(examine_tracker(rig_, Asking::not_now).size(), 1u);
  const test::ScriptedRuntime runtime("no_hands");
  const auto found = finding_of(examine_tracker(rig_, Asking::now), "tracker service");
  EXPECT_EQ(found.grade, Grade::fault);
  EXPECT_THAT(found.sentence, HasSubstr("no hand tracker"));
}
#endif

Greys greys_of(int background, int hand, double share) {
  std::vector<std::uint8_t> pixels(10'000, static_cast<std::uint8_t>(background));
  const auto count = static_cast<std::size_t>(share * 10'000);
  std::fill_n(pixels.begin(), count, static_cast<std::uint8_t>(hand));
  Greys greys;
  greys.add(pixels);
  return greys;
}

TEST(Images, ThoseOfTheReferenceRigAreGood) {
  for (const auto& finding : judge_images(greys_of(13, 70, 0.1), true))
    EXPECT_EQ(finding.grade, Grade::good) << finding.check << ": " << finding.sentence;
}

TEST(Images, EachTroubleHasItsAdvice) {
  const auto advice = [](const Greys& greys, bool has_hand, const char* check) {
    return finding_of(judge_images(greys, has_hand), check).grade == Grade::advice;
  };
  EXPECT_TRUE(advice(greys_of(13, 255, 0.1), true, "exposure"));
  EXPECT_TRUE(advice(greys_of(90, 200, 0.1), true, "background"));
  EXPECT_TRUE(advice(greys_of(13, 25, 0.1), true, "infrared light"));
  EXPECT_TRUE(advice(greys_of(30, 50, 0.1), true, "infrared light")) << "no contrast";
  EXPECT_FALSE(advice(greys_of(13, 25, 0.1), false, "infrared light")) << "nobody is there";
}

TEST(RigFile, ARealCameraNeedsACalibrationOfItsOwn) {
  config::Rig rig;
  EXPECT_FALSE(has_fault(examine_file(rig)));
  rig.camera.backend = "v4l2";
  EXPECT_EQ(finding_of(examine_file(rig), "calibration").grade, Grade::fault);
  rig.calibration = "/nowhere/calibration.toml";
  EXPECT_THAT(finding_of(examine_file(rig), "calibration").sentence, HasSubstr("/nowhere"));
}

TEST(RigFile, ACalibrationThatDoesNotNameItsCameraGetsAdvice) {
  const test::Scratch scratch;
  config::Rig rig;
  rig.camera.backend = "v4l2";
  rig.calibration = scratch.path() / "calibration.toml";
  auto calibration = calib::reference_rig();
  std::ofstream(rig.calibration) << calib::print_calibration(calibration);
  EXPECT_EQ(finding_of(examine_file(rig), "calibration").grade, Grade::advice);
  calibration.camera_device = "Webcam";
  std::ofstream(rig.calibration) << calib::print_calibration(calibration);
  EXPECT_EQ(finding_of(examine_file(rig), "calibration").grade, Grade::good);
}

TEST(RigFile, OfTwoCamerasTheSecondOneIsNamed) {
  const test::Scratch scratch;
  config::Rig rig;
  rig.camera2.backend = "twin";
  rig.calibration = scratch.path() / "calibration.toml";
  auto calibration = calib::reference_rig();
  std::ofstream(rig.calibration) << calib::print_calibration(calibration);
  auto finding = finding_of(examine_file(rig), "calibration");
  EXPECT_EQ(finding.grade, Grade::fault);
  EXPECT_THAT(finding.sentence, HasSubstr("the second camera is not calibrated"));
  EXPECT_THAT(finding.remedy, HasSubstr("lens2 pair"));
  rig.camera.backend = "v4l2";  // whose name is not known, which is less
  EXPECT_EQ(finding_of(examine_file(rig), "calibration").grade, Grade::fault);
  rig.camera.backend = "twin";
  calibration.camera2 = calib::SecondCamera{{}, calibration.camera, glm::dmat4(1)};
  calibration.camera2->camera.width_px = 640;
  calibration.camera2->from_camera[3].x = -0.25;
  calibration.made.pair = "2026-01-02: 15 views";
  std::ofstream(rig.calibration) << calib::print_calibration(calibration);
  finding = finding_of(examine_file(rig), "calibration");
  EXPECT_EQ(finding.grade, Grade::good);
  EXPECT_THAT(finding.sentence, HasSubstr("second camera 640 x 540 px, 250 mm from it (measured "
                                          "2026-01-02)"));
}

TEST(Display, IsJudgedByTheCalibrationAndTheRate) {
  const auto calibration = calib::reference_rig();
  config::Projector projector;
  projector.rate_hz = 60;
  const auto grade = [&](const DisplayMode& mode, const char* check) {
    return finding_of(judge_mode(mode, projector, calibration), check).grade;
  };
  EXPECT_EQ(grade({"it", 1024, 768, 59.94}, "display"), Grade::good);
  EXPECT_EQ(grade({"it", 1024, 768, 59.94}, "display rate"), Grade::good);
  EXPECT_EQ(grade({"it", 1024, 768, 0}, "display rate"), Grade::good) << "an unknown rate";
  EXPECT_EQ(grade({"it", 1024, 768, 120}, "display rate"), Grade::advice);
  EXPECT_EQ(grade({"it", 1280, 800, 60}, "display"), Grade::advice);
  projector.packing = config::Packing::planes_24x1;
  EXPECT_EQ(grade({"it", 1280, 800, 60}, "display"), Grade::fault) << "sub-frames cannot be scaled";
}

TEST(Display, TwoProjectorsNeedOneEach) {
  config::Rig rig;
  rig.calibration = "config/calibrations/left_of_two.toml";
  rig.projector2.calibration = "config/calibrations/right_of_two.toml";
  const auto complaint = [&](const char* backend) {
    rig.projector.backend = rig.projector2.backend = backend;
    std::string all;
    for (const auto& finding : examine_file(rig)) all += finding.sentence + "\n";
    return all;
  };
  EXPECT_THAT(complaint("window"), HasSubstr("have one monitor"));
  EXPECT_THAT(complaint("kms"), HasSubstr("on one graphics card"));
  rig.projector2.window.monitor = "HDMI-2";
  rig.projector2.kms.card = "/dev/dri/card1";
  EXPECT_THAT(complaint("window"), testing::Not(HasSubstr("have one monitor")));
  EXPECT_THAT(complaint("kms"), testing::Not(HasSubstr("on one graphics card")));
}

TEST(Display, IsNotLookedForIfTheRigHasNone) {
  config::Rig rig;
  for (const auto* backend : {"twin", "file"}) {
    rig.projector.backend = backend;
    EXPECT_TRUE(examine_display(rig, calib::reference_rig()).empty());
  }
}

TEST(RigFile, AFaultyFileIsTheOnlyFinding) {
  const auto findings = examine_file(fail(Errc::bad_config, "rig.toml:3: name: no"));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].grade, Grade::fault);
  EXPECT_THAT(findings[0].sentence, HasSubstr("rig.toml:3"));
}

TEST(Start, WhatUpWouldRefuseIsAFaultEach) {
  EXPECT_FALSE(has_fault(judge_check(0, "")));
  const auto findings =
      judge_check(100, "handcast: rig.toml:\ncamera: no such folder\npose: none\n");
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].sentence, "camera: no such folder");
  EXPECT_TRUE(has_fault(findings));
  EXPECT_TRUE(has_fault(judge_check(100, "")));
  const auto with_line = judge_check(100,
                                     "handcast: r.toml:\nc.toml:1:5: text needs quotes\n"
                                     "    a = b\n        ^\nsecond\n");
  ASSERT_EQ(with_line.size(), 2u);
  EXPECT_EQ(with_line[0].sentence, "c.toml:1:5: text needs quotes\n    a = b\n        ^");
}

TEST(Findings, ArePrintedWithTheirRemediesAndCounted) {
  const std::vector<Finding> findings{{"disk", Grade::good, "90 GB are free here", ""},
                                      {"light", Grade::fault, "none came", "look"}};
  const auto text = print(findings);
  EXPECT_THAT(text, HasSubstr("good     disk               90 GB are free here\n"));
  EXPECT_THAT(text, HasSubstr("-> look\n"));
  EXPECT_THAT(text, HasSubstr("faults: 1, advice: 0, good: 1\n"));
  const auto json = nlohmann::json::parse(to_json(findings));
  EXPECT_EQ(json[1]["grade"], "fault");
  EXPECT_TRUE(has_fault(findings));
  EXPECT_FALSE(has_fault({findings[0]}));
}

TEST(JudgeRate, LessThanTheWantedRateIsAFaultUnlessTheServiceIsNotHeldToIt) {
  nlohmann::json ring{{"wanted_hz", 525}, {"held_hz", 172}, {"is_held_to_it", true}};
  const auto grade = [&] { return judge_rate(ring, "camera rate", "camera.rate_hz").grade; };
  EXPECT_EQ(grade(), Grade::fault);
  ring["is_held_to_it"] = false;
  EXPECT_EQ(grade(), Grade::good) << "a recording has its own times";
  ring["held_hz"] = 0;
  EXPECT_EQ(grade(), Grade::fault) << "nothing comes";
}

}  // namespace
}  // namespace handcast::doctor
