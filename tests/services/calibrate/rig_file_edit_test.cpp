// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/rig_file_edit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "config/rig.hpp"
#include "config/settings/files.hpp"
#include "tests/scratch.hpp"

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;

const MeasuredSetting kLatency{"projector.latency_ms", "10.2"};

TEST(RigFileEdit, TheLineOfASettingGetsTheValueAndKeepsItsComment) {
  EXPECT_EQ(with_setting("# mine\n[camera]\nlatency_ms = 1\n[projector]\n  latency_ms=3 # old\n",
                         kLatency),
            "# mine\n[camera]\nlatency_ms = 1\n[projector]\n  latency_ms= 10.2  # old\n");
}

TEST(RigFileEdit, ASettingThatIsNotInItsSectionGetsALineThere) {
  EXPECT_EQ(with_setting("[projector] # light\nrate_hz = 60\n[camera]\n", kLatency),
            "[projector] # light\nlatency_ms = 10.2\nrate_hz = 60\n[camera]\n");
}

TEST(RigFileEdit, ASectionThatIsNotThereIsAdded) {
  EXPECT_EQ(with_setting("name = \"a\"\n", kLatency),
            "name = \"a\"\n\n[projector]\nlatency_ms = 10.2\n");
}

TEST(RigFileEdit, ADottedKeyAtTheTopIsFound) {
  EXPECT_EQ(with_setting("projector.latency_ms = 3\n", kLatency), "projector.latency_ms = 10.2\n");
}

TEST(RigFileEdit, TheSectionOfABackEndIsAnotherOne) {
  EXPECT_EQ(with_setting("[projector.kms]\nlatency_ms = 3\n", kLatency),
            "[projector.kms]\nlatency_ms = 3\n\n[projector]\nlatency_ms = 10.2\n");
}

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

}  // namespace
}  // namespace handcast::calibrate
