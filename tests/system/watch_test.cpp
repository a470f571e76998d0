// SPDX-License-Identifier: Apache-2.0
// The night watch of a rig: light by the hours, one alert for a fault and one for its end, and a
// black box.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "renderer/media/picture.hpp"
#include "services/recording/recording_reader.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class Watch : public SystemTest {
 protected:
  /// Hours that are over in half a minute at the earliest, and begin in 12 hours, or the reverse.
  static std::string hours(bool is_open) {
    const auto text_of = [](std::time_t time) {
      std::tm local{};
      ::localtime_r(&time, &local);
      return fmt::format("{:02}:{:02}", local.tm_hour, local.tm_min);
    };
    const auto now = std::time(nullptr);
    const auto before = text_of(now - 6 * 3600), after = text_of(now + 6 * 3600);
    return is_open ? fmt::format("daily {}-{}", before, after)
                   : fmt::format("daily {}-{}", after, before);
  }
  static std::string date_of_today() {
    const auto now = std::time(nullptr);
    std::tm local{};
    ::localtime_r(&now, &local);
    return fmt::format("{:04}-{:02}-{:02}", local.tm_year + 1900, local.tm_mon + 1, local.tm_mday);
  }
  void write_rig(bool is_open) const {
    std::ofstream(rig_file()) << fmt::format(
        "name = 'twin'\ncamera.rate_hz = 60\nprojector.rate_hz = 60\nobserver.rate_hz = 2\n"
        "landmarks.backend = 'twin'\ntwin.motion = 'builtin:still'\n[watch]\nenabled = true\n"
        "hours = ['{}']\nclosing = ['sh', '-c', 'echo closed >>transitions']\n"
        "opening = ['sh', '-c', 'echo open >>transitions']\n"
        "alert.command = ['sh', '-c', 'cat >>alerts; echo --- >>alerts']\nalert.well_s = 3\n",
        hours(is_open));
  }
  fs::path rig_file() const { return scratch_.path() / "rig.toml"; }
  fs::path folder() const { return scratch_.path() / "rig.watch"; }
  std::unique_ptr<Command> up_watched(bool is_open, const Arguments& more = {}) const {
    write_rig(is_open);
    Arguments arguments{"up", rig_file()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return std::make_unique<Command>(scratch_.path(), arguments);
  }
  /// The rig with an output that writes its light to files.
  std::unique_ptr<Command> up_with_files(bool is_open) const {
    return up_watched(is_open, {"--out", scratch_.path(), "--set", "projector.backend=file",
                                "--set", "projector.file.every=1", "--set", "projector.rate_hz=5"});
  }
  std::string text_of(const fs::path& file) const {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  std::string in_scratch(const char* file) const { return text_of(scratch_.path() / file); }
  static std::size_t count(const std::string& text, const std::string& part) {
    std::size_t number = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++number;
    return number;
  }

  /// Whether the newest picture of the output becomes lit, or black.
  bool becomes(bool lit) const {
    return eventually([&] {
      std::vector<fs::path> pictures;
      std::error_code absent;
      for (const auto& entry : fs::directory_iterator(scratch_.path() / "light", absent))
        if (entry.path().extension() == ".png") pictures.push_back(entry.path());
      if (pictures.empty()) return false;
      const auto newest = std::ranges::max(
          pictures, {}, [](const auto& file) { return fs::last_write_time(file); });
      const auto picture = renderer::read_picture(newest);
      return picture && std::ranges::any_of(picture->pixels(), [](std::uint32_t pixel) {
                          return (pixel & 0xffffff) != 0;
                        }) == lit;
    });
  }
  std::string blackout() const { return handcast({"get", "light.blackout"}).output; }
  /// Returns the pid that it had; 0: it had none.
  pid_t kill_process_of(const std::string& name) const {
    const auto pid = service(name).value("pid", 0);
    if (pid > 0) kill(pid, SIGKILL);
    return pid;
  }
  /// Kills a service whenever it runs, until it is given up.
  void kill_until_degraded(const std::string& name) const {
    EXPECT_TRUE(eventually([&] {
      if (service(name)["state"] == "degraded") return true;
      kill_process_of(name);
      return false;
    }));
  }
  std::vector<fs::path> boxes() const {
    std::vector<fs::path> all;
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(folder() / "faults", absent))
      all.push_back(entry.path());
    return all;
  }
};

TEST_F(Watch, TheLightFollowsTheHoursAndThePersonWhoSwitchesItOnAtNight) {
  const auto rig = up_with_files(true);
  wait_until_light();
  ASSERT_TRUE(becomes(true)) << rig->log();
  write_rig(false);
  ASSERT_EQ(handcast({"reload"}).exit_code, 0) << rig->log();
  EXPECT_TRUE(becomes(false)) << rig->log();
  EXPECT_EQ(handcast({"blackout", "off"}).exit_code, 0);
  EXPECT_TRUE(becomes(true));
  const auto watch = kill_process_of("watch");
  ASSERT_TRUE(eventually([&] {
    const auto again = service("watch");
    return again["state"] == "ready" && again["pid"] != watch && again["uptime_s"] > 3;
  }));
  EXPECT_THAT(blackout(), HasSubstr("= false"));
  write_rig(true);
  ASSERT_EQ(handcast({"reload"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return count(in_scratch("transitions"), "open") == 2; }));
  EXPECT_EQ(in_scratch("transitions"), "open\nclosed\nopen\n");
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(Watch, ARigThatIsStartedOutsideItsHoursIsDark) {
  const auto rig = up_with_files(false);
  wait_until_light();
  EXPECT_TRUE(eventually([&] { return blackout().find("= true") != std::string::npos; }));
  EXPECT_TRUE(becomes(false));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

/// A computer without a battery boots in another year, at another time of day, until it hears of
/// the time.
TEST_F(Watch, AClockThatIsSetAfterTheBootTurnsTheLightOn) {
#ifdef HANDCAST_WITH_SANITIZER
  GTEST_SKIP() << "a sanitizer must be loaded before the library that lets the clock jump";
#endif
  const auto file = (scratch_.path() / "clock").string();
  const auto jump_by = [&](std::int64_t seconds) {
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary)
        .write(reinterpret_cast<const char*>(&seconds), sizeof seconds);
  };
  std::ofstream(file) << std::string(sizeof(std::int64_t), '\0');
  constexpr std::int64_t kDay_s = 86'400;
  jump_by(-9 * 365 * kDay_s - kDay_s / 2);
  const Variable jump("HANDCAST_CLOCK_JUMP", file), preload("LD_PRELOAD", JUMPING_CLOCK);
  const auto rig = up_watched(true);
  ASSERT_TRUE(eventually([&] { return blackout().find("= true") != std::string::npos; }))
      << rig->log();
  jump_by(0);
  EXPECT_TRUE(eventually([&] { return blackout().find("= false") != std::string::npos; }))
      << rig->log();
  expect_more_light();
  EXPECT_TRUE(eventually([&] { return in_scratch("transitions") == "closed\nopen\n"; }));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  const auto day = nlohmann::json::parse(std::ifstream(folder() / (date_of_today() + ".json")));
  EXPECT_LT(day["up_s"], 600) << "the years between were no time of this rig";
}

TEST_F(Watch, AServiceThatIsGivenUpIsOneAlertOneRecoveryAndOneBlackBoxWithoutImages) {
  const auto rig = up_watched(true);
  wait_until_light();
  kill_until_degraded("content");
  ASSERT_TRUE(eventually([&] { return count(in_scratch("alerts"), "---") == 2; }))
      << in_scratch("alerts") << rig->log();
  kill_process_of("content");  // again, within the hour
  EXPECT_TRUE(eventually([&] { return service("content")["state"] == "ready"; }));
  const auto alerts = in_scratch("alerts");
  EXPECT_EQ(count(alerts, "content dies again and again: signal 9"), 2u) << alerts;
  EXPECT_EQ(count(alerts, "it is over"), 1u) << alerts;
  EXPECT_EQ(count(alerts, "---"), 2u) << alerts;

  ASSERT_EQ(boxes().size(), 1u);
  const auto box = boxes().front();
  EXPECT_THAT(alerts, HasSubstr(box.string()));
  EXPECT_FALSE(fs::exists(box / "camera.frames.index"));
  const auto poses = recording::StreamReader::open<msg::HandPoses>(box, "pose.hands");
  ASSERT_TRUE(poses) << poses.error().what;
  EXPECT_GT(poses->rows().size(), 100u);

  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  const auto report = handcast({"day", "--folder", folder()}).output;
  EXPECT_THAT(report, AllOf(HasSubstr("signal 9 (Killed)"), HasSubstr(box.filename().string()),
                            HasSubstr("visit"), HasSubstr("usually"), HasSubstr(".html")));
  const Command again(scratch_.path(), {"play", box, "--seconds", "60"});
  EXPECT_TRUE(eventually([&] {
    auto now = status();
    return now.is_object() && now["rings"]["projection.frames"]["count"] > 0;
  })) << again.log();
  EXPECT_FALSE(status()["services"].contains("watch"));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(Watch, AProgramThatHangsHoldsNothingUp) {
  write_rig(true);
  std::ofstream(rig_file(), std::ios::app) << "command_s = 1\n";
  const Command rig(scratch_.path(),
                    {"up", rig_file(), "--set", R"(watch.opening=["sleep", "1000"])"});
  wait_until_light();
  EXPECT_TRUE(eventually([&] {
    return rig.log().find("'sleep' was killed: it took longer than 1 s") != std::string::npos;
  }));
  EXPECT_EQ(service("watch")["restarts"], 0);
  EXPECT_THAT(handcast({"day"}).output, HasSubstr("open: the light is on"));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(Watch, WrongHoursAreASentenceAtTheStart) {
  const auto outcome =
      handcast({"up", "config/rigs/twin.toml", "--set", R"(watch.hours=["monday 10-18"])"});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, AllOf(HasSubstr("watch.hours: 'monday 10-18' says no hours"),
                                 Not(HasSubstr("ready"))));
}

}  // namespace
}  // namespace handcast::system_test
