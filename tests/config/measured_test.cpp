// SPDX-License-Identifier: Apache-2.0
#include "config/measured.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "config/rig.hpp"
#include "tests/scratch.hpp"

namespace handcast::config {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Measured : public testing::Test {
 protected:
  void write(const std::filesystem::path& file, const std::string& text) const {
    std::ofstream(file) << text;
  }
  Rig load(const std::vector<std::string>& settings = {}) const {
    const auto rig = load_rig(rig_file_, settings);
    EXPECT_TRUE(rig) << rig.error().what;
    return rig ? *rig : Rig{};
  }
  /// The error of a rig with this file of measured settings.
  Error error_with(const std::string& toml) const {
    write(measured_, toml);
    const auto rig = load_rig(rig_file_);
    EXPECT_FALSE(rig);
    return rig ? Error{} : rig.error();
  }

  const test::Scratch scratch_;
  const std::filesystem::path rig_file_ = scratch_.path() / "my.rig.toml",
                              measured_ = scratch_.path() / "my.rig.measured.toml";
};

TEST_F(Measured, ValuesWinOverTheRigFileAndThoseOfSetOverBoth) {
  write(rig_file_, "name = 'mine'\n[projector]\nlatency_ms = 3\ngamma = 1\nrate_hz = 60\n");
  EXPECT_EQ(load().projector.latency_ms, 3);
  write(measured_, "projector.latency_ms = 10.2\nprojector.gamma = 1.80\n");
  const auto rig = load({"projector.gamma=2.2"});
  EXPECT_EQ(rig.projector.latency_ms, 10.2);
  EXPECT_EQ(rig.projector.gamma, 2.2);
  EXPECT_EQ(rig.projector.rate_hz, 60);
  EXPECT_EQ(rig.name, "mine");
}

TEST_F(Measured, PathsStartAtTheFolderOfTheFiles) {
  write(rig_file_, "calibration = 'a.toml'\n");
  write(measured_, "calibration = 'b.toml'\n");
  EXPECT_EQ(load().calibration, scratch_.path() / "b.toml");
}

TEST_F(Measured, FaultsNameTheFileThatHasThem) {
  write(rig_file_, "[projector]\nlatency_ms = 3\n");
  EXPECT_THAT(error_with("\nprojector.latency_ms = -5\n").what,
              HasSubstr("my.rig.measured.toml:2: projector.latency_ms"));
  EXPECT_THAT(error_with("projector.latncy_ms = 5\n").what,
              HasSubstr("my.rig.measured.toml:1: projector.latncy_ms"));
  EXPECT_THAT(error_with("projector.latency_ms = \n").what, HasSubstr("my.rig.measured.toml:1"));
  write(rig_file_, "[projector]\ngama = 3\n");
  const auto both = error_with("projector.latency_ms = -5\n").what;
  EXPECT_THAT(both, HasSubstr("my.rig.toml:2: projector.gama"));
  EXPECT_THAT(both, HasSubstr("my.rig.measured.toml:1: projector.latency_ms"));
}

TEST_F(Measured, SettingsAreReadAsTheyWereWritten) {
  const std::vector<MeasuredSetting> settings{{"calibration", R"("rig \"2\"\\.toml")"},
                                              {"projector.latency_ms", "10.2"},
                                              {"twin.geometry.calibration", R"("truth.toml")"}};
  const auto read = parse_measured(print_measured(settings), measured_);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(*read, settings);
  write(rig_file_, "");
  write(measured_, print_measured(settings));
  EXPECT_EQ(load().calibration, scratch_.path() / R"(rig "2"\.toml)");
}

TEST_F(Measured, SettingsMayBeInSectionsAsAPersonWritesThem) {
  write(measured_, "# mine\n[projector]\nlatency_ms = 4 # ms\n[camera]\n");
  const auto read = read_measured(measured_);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(*read, ElementsAre(MeasuredSetting{"projector.latency_ms", "4"}));
}

TEST_F(Measured, WithoutAFileThereAreNone) {
  const auto read = read_measured(measured_);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_TRUE(read->empty());
}

TEST_F(Measured, AFileThatCannotBeReadIsAnErrorAndNotNone) {
  write(rig_file_, "");
  std::filesystem::create_directory(measured_);
  const auto rig = load_rig(rig_file_);
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().what, HasSubstr("my.rig.measured.toml"));
  EXPECT_FALSE(read_measured(measured_));
}

TEST_F(Measured, ARigInMemoryHasNone) {
  write(measured_, "projector.latency_ms = 10\n");
  EXPECT_NE(parse_rig("", rig_file_)->projector.latency_ms, 10);
}

}  // namespace
}  // namespace handcast::config
