// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/kept_file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Result<void> any(const fs::path& /*kept*/) { return {}; }

class KeptFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string text() const {
    std::ifstream stream(file_);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  /// The kept version with this text.
  fs::path only_kept(const std::string& wanted) const {
    for (const auto& entry : fs::directory_iterator(folder_)) {
      std::ifstream stream(entry.path());
      if (entry.path() != file_ &&
          std::string(std::istreambuf_iterator<char>(stream), {}) == wanted)
        return entry.path();
    }
    return {};
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("handcast-kept-" + std::to_string(getpid()));
  const fs::path file_ = folder_ / "desk.toml";
};

TEST_F(KeptFile, NoVersionIsLostEvenWithinASecond) {
  for (const char* version : {"one", "two", "three"}) ASSERT_TRUE(write_and_keep(file_, version));
  EXPECT_EQ(text(), "three");
  EXPECT_EQ(files(), 3);
}

TEST_F(KeptFile, TheLastChangeIsTakenBackAndThatToo) {
  for (const char* version : {"one", "two"}) ASSERT_TRUE(write_and_keep(file_, version));
  std::ofstream(folder_ / "desk.notes.toml") << "of somebody else";
  const auto taken_back = take_back(file_, any);
  ASSERT_TRUE(taken_back) << taken_back.error().what;
  EXPECT_EQ(text(), "one");
  ASSERT_TRUE(take_back(file_, any));
  EXPECT_EQ(text(), "two");
}

/// As `TZ` of a shell; the zone of the test afterwards.
class Zone {
 public:
  explicit Zone(const char* name) { set(name); }
  ~Zone() { set("UTC"); }
  static void set(const char* name) {
    setenv("TZ", name, 1);
    tzset();
  }
};

TEST_F(KeptFile, TheOneBeforeTheLastComesBackAlsoIfTheClockWentBack) {
  const Zone zone("UTC-14");  // in the POSIX form, 14 h east of Greenwich
  ASSERT_TRUE(write_and_keep(file_, "one"));
  ASSERT_TRUE(write_and_keep(file_, "two"));
  Zone::set("UTC+8");
  ASSERT_TRUE(write_and_keep(file_, "three"));
  // A version of a time when the clock was wrong.
  fs::rename(only_kept("two"), folder_ / "desk.0002-1999-12-31T235959Z.toml");
  ASSERT_TRUE(take_back(file_, any));
  EXPECT_EQ(text(), "two");
}

TEST_F(KeptFile, WhatIsChangedTogetherHasOneNumber) {
  const auto other = folder_ / "rig.toml";
  for (const char* version : {"one", "two", "three"}) ASSERT_TRUE(write_and_keep(other, version));
  ASSERT_TRUE(write_and_keep(file_, "one"));
  const int above = newest_number({file_, other});
  ASSERT_TRUE(write_and_keep(file_, "two", above));
  ASSERT_TRUE(write_and_keep(other, "four", above));
  EXPECT_EQ(newest_number({file_}), 3);
  EXPECT_EQ(newest_number({other}), 3);
}

TEST_F(KeptFile, OneThatCannotBeUsedAndThatOfAnotherDeviceAreLeftAlone) {
  for (const char* version : {"one", "damaged", "three"})
    ASSERT_TRUE(write_and_keep(file_, version));
  std::ofstream(folder_ / "desk.Basler2463THDMI_1.toml") << "of another device";
  const auto is_whole = [](const fs::path& kept) -> Result<void> {
    std::string word;
    std::ifstream(kept) >> word;
    if (word == "damaged") return fail(Errc::bad_config, "it is damaged");
    return {};
  };
  const auto taken_back = take_back(file_, is_whole);
  ASSERT_TRUE(taken_back) << taken_back.error().what;
  EXPECT_THAT(*taken_back, HasSubstr("it is damaged"));
  EXPECT_EQ(text(), "one");
  EXPECT_TRUE(fs::exists(folder_ / "desk.Basler2463THDMI_1.toml"));
}

TEST_F(KeptFile, WithoutAnEarlierOneThatIsSaid) {
  ASSERT_TRUE(write_and_keep(file_, "one"));
  const auto none = take_back(file_, any);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::bad_config);
  EXPECT_THAT(none.error().what, HasSubstr("no earlier calibration is kept"));
  EXPECT_EQ(text(), "one");
}

}  // namespace
}  // namespace handcast::calibrate
