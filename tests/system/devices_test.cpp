// SPDX-License-Identifier: Apache-2.0
// `handcast devices` sees an emulated camera of each kind, and an emulated graphics card.
#include <gmock/gmock.h>

#include <fstream>

#include "tests/services/camera/aravis/fake_camera.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Devices : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
#ifdef HANDCAST_WITH_SANITIZER
    GTEST_SKIP() << "a sanitizer must be loaded before the emulated devices";
#endif
  }
  static nlohmann::json device_with(const nlohmann::json& devices, const std::string& setting,
                                    const std::string& value) {
    for (const auto& device : devices)
      if (device["settings"].value(setting, "") == value) return device;
    return nullptr;
  }
};

TEST_F(Devices, EachIsListedWithTheSettingsThatUseIt) {
  const test::FakeCamera gige;
  ASSERT_TRUE(gige.is_running());
  const auto plug = scratch_.path() / "plug";
  std::ofstream(plug) << "in";
  const Variable preload("LD_PRELOAD", HANDCAST_EMULATED_DEVICES),
      webcam("HANDCAST_EMULATED_WEBCAM", plug.c_str()), card("HANDCAST_EMULATED_CARD", "EPSON PJ");
  const auto listed = handcast({"devices", "--json"});
  ASSERT_EQ(listed.exit_code, 0) << listed.log;
  const auto devices = nlohmann::json::parse(listed.output);

  const auto camera = device_with(devices, "camera.aravis.device", "GV01");
  ASSERT_FALSE(camera.is_null()) << listed.output;
  EXPECT_EQ(camera["settings"]["camera.backend"], "aravis");
  EXPECT_EQ(camera["trouble"], "");
  EXPECT_EQ(camera["names"][0], "GV01");
  EXPECT_GE(camera["modes"][0]["width_px"], 720);
  EXPECT_LT(camera["modes"][0]["least_width_px"], 720) << "a region of the sensor";
  EXPECT_GT(camera["modes"][0]["rate_hz"], 0);
  const auto video = device_with(devices, "camera.v4l2.device", "/dev/video0");
  ASSERT_FALSE(video.is_null()) << listed.output;
  EXPECT_EQ(video["settings"]["camera.backend"], "v4l2");
  EXPECT_THAT(video["about"].get<std::string>(), HasSubstr("720x540"));
  EXPECT_EQ(video["names"][0], "Emulated Webcam");
  EXPECT_EQ(video["modes"][0]["format"], "GREY");
  EXPECT_EQ(video["modes"][0]["rate_hz"], 100);
  const auto display = device_with(devices, "projector.kms.connector", "HDMI-A-1");
  ASSERT_FALSE(display.is_null()) << listed.output;
  EXPECT_EQ(display["names"], (nlohmann::json{"EPSON PJ", "HDMI-A-1"}));
  EXPECT_EQ(display["modes"][0]["height_px"], 768);
  EXPECT_THAT(display["name"].get<std::string>(), HasSubstr("EPSON PJ"));

  const auto text = handcast({"devices"}).output;
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("cameras\n"),
            HasSubstr("[camera]\n      backend = \"aravis\"\n      aravis.device = \"GV01\"\n"),
            HasSubstr("displays\n")));
}

TEST_F(Devices, TheDoctorLooksForTheIndustrialCameraOfTheRig) {
  const test::FakeCamera gige;
  ASSERT_TRUE(gige.is_running());
  const auto camera = [this](const std::string& name) {
    const auto outcome =
        handcast({"doctor", "config/rigs/twin.toml", "--json", "--set", "camera.backend=aravis",
                  "--set", "camera.aravis.device=" + name});
    for (const auto& finding : nlohmann::json::parse(outcome.output))
      if (finding["check"] == "camera device") return finding;
    return nlohmann::json();
  };
  for (const auto* name : {"", "GV01", "127.0.0.1"}) {
    const auto found = camera(name);
    EXPECT_EQ(found["grade"], "good") << name << found;
    EXPECT_THAT(found["sentence"].get<std::string>(), HasSubstr("serial number GV01, GigEVision"));
  }
  const auto absent = camera("GV99");
  EXPECT_EQ(absent["grade"], "fault");
  EXPECT_EQ(absent["sentence"], "there is no camera 'GV99'");
  EXPECT_THAT(absent["remedy"].get<std::string>(), HasSubstr("GV01"));
}

TEST_F(Devices, AFileOfABackEndThatCannotBeLoadedIsListedWithItsTrouble) {
  const auto folder = scratch_.path() / "handcast/camera";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "mine.so") << "this is no library";
  const Variable place("LD_LIBRARY_PATH", scratch_.path().c_str());
  EXPECT_THAT(handcast({"devices"}).output,
              HasSubstr("  camera 'mine'\n    cannot be used: " + (folder / "mine.so").string()));
}

TEST_F(Devices, AFileOfABackEndThatEndsItsProgramIsTold) {
  const auto folder = scratch_.path() / "handcast/camera";
  std::filesystem::create_directories(folder);
  std::ofstream(scratch_.path() / "deadly.c")
      << "#include <stdlib.h>\n__attribute__((constructor)) static void end(void) { _Exit(7); }\n";
  ASSERT_EQ(std::system(("cc -shared -fPIC -o " + (folder / "deadly.so").string() + " " +
                         (scratch_.path() / "deadly.c").string())
                            .c_str()),
            0);
  const Variable place("LD_LIBRARY_PATH", scratch_.path().c_str());
  EXPECT_THAT(handcast({"devices"}).output, HasSubstr("cannot be used: not a list of devices"));
  const auto doctor =
      handcast({"doctor", "config/rigs/twin.toml", "--json", "--set", "camera.backend=aravis"});
  EXPECT_THAT(doctor.output, HasSubstr("not a list of devices"));
}

TEST_F(Devices, TheDoctorLooksAtTheDisplayOfTheRig) {
  const Variable preload("LD_PRELOAD", HANDCAST_EMULATED_DEVICES),
      card("HANDCAST_EMULATED_CARD", "EPSON PJ");
  const auto display = [this](const std::string& connector) {
    const auto outcome =
        handcast({"doctor", "config/rigs/twin.toml", "--json", "--set", "projector.backend=kms",
                  "--set", "projector.kms.connector=" + connector});
    for (const auto& finding : nlohmann::json::parse(outcome.output))
      if (finding["check"] == "display") return finding;
    return nlohmann::json();
  };
  EXPECT_THAT(display("HDMI-A-1")["sentence"].get<std::string>(), HasSubstr("EPSON PJ"));
  EXPECT_EQ(display("VGA-9")["grade"], "fault");
}

TEST_F(Devices, InitWritesARigThatAnIndustrialCameraAccepts) {
  const test::FakeCamera gige;
  ASSERT_TRUE(gige.is_running());
  const std::string file = scratch_.path() / "gige.toml";
  const auto written = handcast({"init", file, "--camera", "GV01", "--output", "twin"});
  ASSERT_EQ(written.exit_code, 0) << written.log;
  EXPECT_THAT(written.output, AllOf(HasSubstr("serial number GV01, 720x540 at "),
                                    HasSubstr("calibration  MISSING")));
  Command rig(scratch_.path(), {"up", file});
  EXPECT_TRUE(eventually([&] { return service("camera")["state"] == "ready"; })) << rig.log();
  EXPECT_EQ(service("camera")["backend"], "aravis");
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(Devices, AWrongWordIsAUsageError) {
  for (const auto* verb : {"devices", "doctor"}) {
    const auto outcome = handcast({verb, "--nonsense"});
    EXPECT_EQ(outcome.exit_code, 2) << verb;
    EXPECT_THAT(outcome.log, HasSubstr(std::string("handcast ") + verb + ": "));
  }
}

TEST_F(Devices, WithoutAnyTheCommandSaysSo) {
  const auto text = handcast({"devices"}).output;
  EXPECT_THAT(text, HasSubstr("cameras\n  none\n"));
}

}  // namespace
}  // namespace handcast::system_test
