// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/rig_file_edit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "config/rig.hpp"
#include "config/settings/files.hpp"
#include "tests/scratch.hpp"

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;

const MeasuredSetting kLatency{"projector.latency_ms", "10.2"};

class AppliedSettings : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(file_) << text; }

  test::Scratch scratch_;
  const std::filesystem::path file_ = scratch_.path() / "rig.toml";
};

TEST_F(AppliedSettings, AreReadBackAndTheOldFileIsKept) {
  write("name = \"mine\"\n");
  const std::vector<MeasuredSetting> settings{kLatency, {"projector.gamma", "1.80"}};
  const auto applied = apply_settings(file_, settings);
  ASSERT_TRUE(applied) << applied.error().what;
  const auto rig = config::load_rig(file_, {});
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->projector.latency_ms, 10.2);
  EXPECT_EQ(rig->projector.gamma, 1.8);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scratch_.path()))
    if (entry.path() != file_) {
      ++files;
      EXPECT_EQ(*config::read_text(entry.path()), "name = \"mine\"\n");
      EXPECT_THAT(*applied, HasSubstr(entry.path().filename().string()));
    }
  EXPECT_EQ(files, 1);
}

TEST_F(AppliedSettings, AFileThatWouldBeInvalidStaysAsItWas) {
  write("name = \"mine\"\n");
  const std::vector<MeasuredSetting> settings{{"projector.latency_ms", "-5"}};
  const auto applied = apply_settings(file_, settings);
  ASSERT_FALSE(applied);
  EXPECT_THAT(applied.error().what, HasSubstr("latency_ms"));
  EXPECT_EQ(*config::read_text(file_), "name = \"mine\"\n");
}

TEST_F(AppliedSettings, AreWrittenIntoTheFormsThatThePersonUses) {
  write("name = \"mine\"\r\nprojector = { rate_hz = 60 } # bright\r\n");
  const std::vector<MeasuredSetting> settings{kLatency, {"projector.gamma", "1.80"}};
  const auto applied = apply_settings(file_, settings);
  ASSERT_TRUE(applied) << applied.error().what;
  EXPECT_EQ(*config::read_text(file_),
            "name = \"mine\"\r\nprojector = { rate_hz = 60, latency_ms = 10.2, gamma = 1.80 } # "
            "bright\r\n");
}

TEST_F(AppliedSettings, EachRigOfTheProjectTakesThem) {
  const std::vector<MeasuredSetting> settings{kLatency, {"projector.gamma", "1.80"}};
  int rigs = 0;
  const char* source = std::getenv("HANDCAST_SOURCE");
  const auto folder = std::filesystem::path(source ? source : ".") / "config/rigs";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    ++rigs;
    const auto before = *config::read_text(entry.path());
    write(before);
    const auto applied = apply_settings(file_, settings);
    ASSERT_TRUE(applied) << applied.error().what;
    const auto rig = config::load_rig(file_, {});
    ASSERT_TRUE(rig) << rig.error().what;
    EXPECT_EQ(rig->projector.latency_ms, 10.2);
    EXPECT_EQ(rig->projector.gamma, 1.8);
  }
  EXPECT_GE(rigs, 6);
}

TEST_F(AppliedSettings, TheNameOfACalibrationIsWrittenAboveTheFirstSection) {
  write("# mine\n[camera]\nrate_hz = 100\n");
  const std::vector<MeasuredSetting> settings{{"calibration", R"(rig "2"\.toml)"}, kLatency};
  const auto applied = apply_settings(file_, settings);
  ASSERT_TRUE(applied) << applied.error().what;
  EXPECT_EQ(config::load_rig(file_, {})->calibration, scratch_.path() / R"(rig "2"\.toml)");
  EXPECT_TRUE(config::read_text(file_)->ends_with(
      "# mine\n[camera]\nrate_hz = 100\n\n[projector]\nlatency_ms = 10.2\n"));
}

TEST_F(AppliedSettings, ThoseThatAreThereAlreadyLeaveTheFileAlone) {
  write("[projector]\nlatency_ms = 10.2\n");
  const std::vector<MeasuredSetting> settings{kLatency};
  ASSERT_TRUE(apply_settings(file_, settings));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch_.path()), {}), 1);
}

TEST_F(AppliedSettings, LeaveThePersonsFilesBesideItAlone) {
  write("name = \"mine\"\n");
  for (const char* name : {"rig.toml.new.toml", "rig.toml.tmp"})
    std::ofstream(scratch_.path() / name) << "my own";
  const std::vector<MeasuredSetting> settings{kLatency};
  ASSERT_TRUE(apply_settings(file_, settings));
  for (const char* name : {"rig.toml.new.toml", "rig.toml.tmp"})
    EXPECT_EQ(*config::read_text(scratch_.path() / name), "my own");
}

}  // namespace
}  // namespace handcast::calibrate
