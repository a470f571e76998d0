// SPDX-License-Identifier: Apache-2.0
#include "services/watch/night_watch.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "config/live/live_values.hpp"
#include "ipc/base/clock.hpp"
#include "services/watch/lights.hpp"
#include "services/watch/report.hpp"
#include "tests/scratch.hpp"
#include "tests/services/watch/a_day.hpp"

namespace handcast::watch {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A watch without a supervisor, whose clock the test turns. It is open from 10 to 18.
class NightWatchTest : public testing::Test {
 protected:
  void SetUp() override {
    test::use_utc();
    std::ofstream(scratch_.path() / "show.toml") << "";
    rig_.name = "nobody";
    rig_.watch.hours = {"daily 10:00-18:00"};
    rig_.projector.lamp.pjlink = "10.0.0.7";
  }
  config::LiveBoard board() const {
    auto ring = ipc::Segment::open(UniqueFd(::dup(ring_.fd())));
    return {std::move(*ring), rig_, scratch_.path() / "show.toml"};
  }
  /// The light as people and the watch have set it.
  config::Light light() const {
    const auto now = board().now();
    return config::with_live(rig_, now->values.view())->light;
  }
  std::string author() const { return std::string(board().now()->source.view()); }
  void set(const std::string& assignment) const {
    const std::vector<std::string> all{assignment};
    ASSERT_TRUE(board().set(all, "somebody"));
  }
  /// At "10:00:05" of the day that many days after 2026-12-24.
  static Moment at(const std::string& clock, int day = 0) {
    std::tm utc{.tm_mday = 24 + day, .tm_mon = 11, .tm_year = 126};
    EXPECT_NE(::strptime(clock.c_str(), "%H:%M:%S", &utc), nullptr);
    const auto time = ::timegm(&utc);
    return {1'000'000'000 * (time - test::kNoon + 1'000'000), time};
  }
  void start(Moment now, std::int64_t rig_started_ns = 7) {
    if (watch_) watch_->stop(now);
    watch_.reset();
    auto opened = NightWatch::open(
        {.settings = rig_,
         .calibration = "",
         .started_ns = rig_started_ns,
         .ring = [](auto) -> Result<ipc::Segment> { return fail(Errc::unavailable, "none"); }},
        Lights(board()), now);
    ASSERT_TRUE(opened) << opened.error().what;
    watch_ = std::move(*opened);
    watch_->turn(now);
  }
  std::filesystem::path folder() const { return scratch_.path() / "show.watch"; }
  Day day(const std::string& date) const { return *load_day(folder(), date).value(); }
  std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(scratch_.path() / name).rdbuf();
    return text.str();
  }
  /// Turns until a file is there.
  std::string await(const std::string& name, Moment now) {
    using namespace std::chrono_literals;
    for (const auto limit = Deadline::in(60s); text_of(name).empty() && !limit.passed();) {
      watch_->turn(now);
      sleep_until_ns(now_ns() + to_ns(1ms));
    }
    return text_of(name);
  }

  static int count_of(const std::string& part, const std::string& text) {
    int count = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
    return count;
  }

  ::handcast::test::Scratch scratch_;
  config::Rig rig_;
  ipc::Segment ring_ =
      *ipc::Segment::create(ipc::RingSpec::of<msg::LiveSettings>("live.settings", 8, false));
  std::unique_ptr<NightWatch> watch_;
};

TEST_F(NightWatchTest, TheLightGoesAtClosingTimeAndComesAtOpeningTime) {
  start(at("12:00:00"));
  EXPECT_FALSE(light().blackout);
  EXPECT_EQ(light().lamp, config::Lamp::on);
  watch_->turn(at("17:59:59"));
  EXPECT_FALSE(light().blackout);
  watch_->turn(at("18:00:00"));
  EXPECT_TRUE(light().blackout);
  EXPECT_EQ(light().lamp, config::Lamp::off);
  EXPECT_EQ(author(), "night watch");
  watch_->turn(at("10:00:00", 1));
  EXPECT_FALSE(light().blackout);
  EXPECT_EQ(light().lamp, config::Lamp::on);
}

TEST_F(NightWatchTest, ARigThatIsStartedAtNightIsDark) {
  start(at("03:00:00"));
  EXPECT_TRUE(light().blackout);
}

TEST_F(NightWatchTest, WhoSwitchesOnTheLightAtNightKeepsItUntilTheNextTransition) {
  start(at("20:00:00"));
  ASSERT_TRUE(light().blackout);
  set("light.blackout=false");
  for (const auto* clock : {"20:00:10", "22:00:00", "23:59:59"}) watch_->turn(at(clock));
  watch_->turn(at("00:00:01", 1));
  EXPECT_FALSE(light().blackout);
  start(at("00:00:05", 1));  // the watch was started again, not the rig
  EXPECT_FALSE(light().blackout);
  watch_->turn(at("10:00:01", 1));
  watch_->turn(at("18:00:01", 1));
  EXPECT_TRUE(light().blackout);
  set("light.blackout=false");
  start(at("19:00:00", 1), 8);  // the rig was
  EXPECT_TRUE(light().blackout);
}

TEST_F(NightWatchTest, ARigThatIsAlwaysOpenIsLeftAlone) {
  rig_.watch.hours.clear();
  set("light.blackout=true");
  start(at("12:00:00"));
  watch_->turn(at("13:00:00"));
  EXPECT_TRUE(light().blackout);
  EXPECT_EQ(author(), "somebody");
}

TEST_F(NightWatchTest, ARigWithoutALampHasNoneSwitched) {
  rig_.projector.lamp.pjlink.clear();
  start(at("20:00:00"));
  EXPECT_TRUE(light().blackout);
  EXPECT_EQ(light().lamp, config::Lamp::unchanged);
}

TEST_F(NightWatchTest, ProgramsRunAtTheTransitionsAndTheirFailureIsInTheReport) {
  rig_.watch.opening = {"sh", "-c", "echo opened >>opened"};
  rig_.watch.closing = {"sh", "-c", "echo no such socket; exit 3"};
  start(at("12:00:00"));
  EXPECT_EQ(await("opened", at("12:00:00")), "opened\n");
  watch_->turn(at("18:00:00"));
  const auto failed = [&] {
    watch_->stop(at("18:00:05"));
    return report_text(day("2026-12-24"));
  };
  using namespace std::chrono_literals;
  for (const auto limit = Deadline::in(60s); !limit.passed();) {
    watch_->turn(at("18:00:01"));
    if (failed().find("no such socket") != std::string::npos) break;
  }
  EXPECT_THAT(failed(), HasSubstr("'sh' ended with exit 3: no such socket"));
  EXPECT_EQ(text_of("opened"), "opened\n");
}

TEST_F(NightWatchTest, AFaultThatLastsForHalfAnHourAsksForAReboot) {
  rig_.watch.black_box.seconds = 0;
  start(at("12:00:00"));
  watch_->turn(at("12:01:00"));
  watch_->turn(at("12:30:00"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "gives-up"));
  watch_->turn(at("12:31:00"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "gives-up"));
  std::filesystem::remove(folder() / "gives-up");
  watch_->turn(at("12:32:00"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "gives-up"));  // once
}

TEST_F(NightWatchTest, AStartOfTheRigIsToldIfThatIsWantedAndOneOfTheWatchIsNot) {
  rig_.watch.alert.command = {"sh", "-c", "cat >>alerts"};
  rig_.watch.alert.starts = true;
  start(at("12:00:00"));
  EXPECT_THAT(await("alerts", at("12:00:01")), HasSubstr("the rig was started"));
  std::filesystem::remove(scratch_.path() / "alerts");
  start(at("12:00:02"));
  rig_.watch.alert.command = {"sh", "-c", "cat >>next"};
  start(at("12:00:03"), 8);
  EXPECT_NE(await("next", at("12:00:04")), "");
  EXPECT_EQ(text_of("alerts"), "");
}

TEST_F(NightWatchTest, EachDayHasItsReportWhichIsWrittenAtClosingTimeAtMidnightAndAtTheEnd) {
  start(at("17:00:00"));
  watch_->turn(at("18:00:00"));
  EXPECT_EQ(day("2026-12-24").lights, false);
  EXPECT_THAT(text_of("show.watch/2026-12-24.html"), HasSubstr("closed: the light is off"));
  watch_->turn(at("23:59:58"));
  watch_->turn(at("00:00:01", 1));
  watch_->stop(at("00:00:02", 1));
  EXPECT_THAT(report_text(day("2026-12-24")), HasSubstr("the rig was started"));
  EXPECT_THAT(report_text(day("2026-12-25")), Not(HasSubstr("the rig was started")));
  EXPECT_EQ(day("2026-12-25").starts, 0);
}

TEST_F(NightWatchTest, AClockThatIsWrongAtBootLosesNoDay) {
  start(at("12:00:00"));
  watch_->stop(at("12:00:01"));
  watch_.reset();
  start(at("12:00:00", -9000), 8);  // the rig starts before the clock is set
  watch_->turn(at("12:30:00"));
  watch_->stop(at("12:30:01"));
  EXPECT_EQ(count_of("the rig was started", report_text(day("2026-12-24"))), 1);
  EXPECT_EQ(day("2026-12-24").rig_started_ns, 8);
  EXPECT_EQ(day("2026-12-24").lights, true);
}

TEST_F(NightWatchTest, OldDaysAreRemoved) {
  rig_.watch.days = 2;
  start(at("12:00:00"));
  for (int i = 1; i < 5; ++i) watch_->turn(at("00:00:01", i));
  watch_->stop(at("00:00:02", 4));
  EXPECT_THAT(dates_in(folder()), testing::ElementsAre("2026-12-27", "2026-12-28"));
}

TEST_F(NightWatchTest, ADamagedDayIsPutAsideAndBegunAnew) {
  std::filesystem::create_directories(folder());
  std::ofstream(json_file(folder(), "2026-12-24")) << "{";
  start(at("12:00:00"));
  watch_->stop(at("12:00:01"));
  EXPECT_EQ(day("2026-12-24").starts, 1);
  EXPECT_EQ(text_of("show.watch/2026-12-24.json.damaged"), "{");
}

TEST_F(NightWatchTest, ASupervisorThatDoesNotAnswerIsToldToTheAlertProgramOnce) {
  rig_.watch.alert.command = {"sh", "-c", "cat >>alerts"};
  rig_.watch.black_box.seconds = 0;
  start(at("12:00:00"));
  for (const auto* clock : {"12:00:10", "12:00:31"}) watch_->turn(at(clock));
  ASSERT_NE(await("alerts", at("12:00:32")), "");
  for (int i = 33; i < 60; ++i) watch_->turn(at(fmt::format("12:00:{}", i)));
  EXPECT_THAT(text_of("alerts"),
              testing::AllOf(HasSubstr("rig 'nobody'"), HasSubstr("has not answered for 31 s"),
                             HasSubstr("2026-12-24.html"), Not(HasSubstr("32 s"))));
}

}  // namespace
}  // namespace handcast::watch
