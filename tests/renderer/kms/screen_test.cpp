// SPDX-License-Identifier: Apache-2.0
// The screen with libdrm, on a card whose kernel part is emulated.
#include "renderer/kms/screen.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/renderer/kms/emulated_card.hpp"

namespace handcast::renderer::kms {
namespace {

using namespace std::chrono_literals;
using test::timing;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint32_t kOrange = 0xff0080ff, kBlack = 0xff000000;

/// A picture of 1024 x 768 that is orange in its region and white where nothing may be shown.
struct Square {
  explicit Square(Rect where = {100, 50, 200, 150}) : region(where) {
    for (int y = region.y0; y < region.y1; ++y)
      std::fill_n(pixels.row(y) + region.x0, region.width(), kOrange);
  }
  Rect region;
  Image<std::uint32_t> pixels{1024, 768, 0xffffffff};
};

int count(const Image<std::uint32_t>& picture, std::uint32_t colour) {
  return static_cast<int>(std::ranges::count(picture.pixels(), colour));
}

class KmsScreen : public testing::Test {
 protected:
  KmsScreen() {
    card_.plug_in("HDMI-A-1", "EPSON PJ",
                  {timing(1920, 1080, 60), timing(1024, 768, 60), timing(1024, 768, 120)});
  }
  static ScreenSettings settings() { return {.width_px = 1024, .height_px = 768, .rate_hz = 100}; }
  static Result<Flip> show(Screen& screen, const Square& square) {
    return screen.show(square.pixels.view(), square.region, Deadline::in(5s));
  }
  /// Shows a picture until show() succeeds, or fails.
  static Result<Flip> show_until(Screen& screen, bool success) {
    auto shown = show(screen, Square());
    for (const auto limit = Deadline::in(20s); shown.has_value() != success && !limit.passed();)
      shown = show(screen, Square());
    return shown;
  }
  /// The sentence with which a screen is refused.
  static Error refusal(const ScreenSettings& settings) {
    const auto refused = Screen::open(settings);
    return refused ? Error{Errc::bad_data, "it was not refused"} : refused.error();
  }

  test::EmulatedCard card_;
};

TEST_F(KmsScreen, ScansOutThePictureAndNothingElse) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  EXPECT_EQ(count(card_.scanned("HDMI-A-1"), kBlack), 1024 * 768) << "black at first";
  for (const Rect region : {Rect{100, 50, 200, 150}, Rect{150, 100, 180, 300}, Rect{},
                            Rect{0, 0, 1024, 768}, Rect{1000, 700, 1024, 768}}) {
    const Square square(region);
    ASSERT_TRUE(show(**screen, square));
    const auto seen = card_.scanned("HDMI-A-1");
    EXPECT_EQ(count(seen, kOrange), region.width() * region.height());
    EXPECT_EQ(count(seen, kBlack), 1024 * 768 - region.width() * region.height());
    if (region.empty()) continue;
    EXPECT_EQ(seen.at(region.x0, region.y0), kOrange);
    EXPECT_EQ(seen.at(region.x1 - 1, region.y1 - 1), kOrange);
  }
}

TEST_F(KmsScreen, HasTheSameColoursOnACardThatWantsBlueFirst) {
  card_.set({.has_red_first = false});
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  ASSERT_TRUE(show(**screen, Square()));
  EXPECT_EQ(count(card_.scanned("HDMI-A-1"), kOrange), 100 * 100);
}

TEST_F(KmsScreen, NeverWritesToThePictureThatIsShown) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  for (int i = 0; i < 30; ++i)
    ASSERT_TRUE(show(**screen, Square({10 * i, 5 * i, 10 * i + 80, 5 * i + 60})));
  EXPECT_EQ(card_.flips().size(), 30u);
  EXPECT_EQ(card_.torn(), 0);
}

TEST_F(KmsScreen, CopiesOnlyWhatChanges) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(show(**screen, Square()));
  card_.scribble(700, 600, 0x123456);
  card_.scribble(150, 100, 0x123456);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(show(**screen, Square()));
  EXPECT_THAT(card_.pixels_at(700, 600), testing::Each(0x123456u)) << "far from the light";
  EXPECT_THAT(card_.pixels_at(150, 100), testing::Each(kOrange)) << "in the light";
}

TEST_F(KmsScreen, ReportsTheTimesOfTheFlips) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  std::vector<Flip> reported;
  for (int i = 0; i < 10; ++i) {
    if (i == 5) sleep_until_ns(now_ns() + 3 * (*screen)->refresh_ns());  // a late frame
    const auto flip = show(**screen, Square());
    ASSERT_TRUE(flip) << flip.error().what;
    reported.push_back(*flip);
  }
  const auto real = card_.flips();
  ASSERT_EQ(real.size(), reported.size());
  for (std::size_t i = 0; i < real.size(); ++i) {
    EXPECT_EQ(reported[i].flip_ns, real[i].time_ns);
    EXPECT_EQ(reported[i].refreshes, i == 0 ? 0 : real[i].sequence - real[i - 1].sequence);
  }
  EXPECT_GE(reported[5].refreshes, 3u);
}

TEST_F(KmsScreen, IsLitInTheModeNextToTheWantedRate) {
  const auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  EXPECT_EQ(card_.lit_mode("HDMI-A-1"), "1024x768@120");
  EXPECT_NEAR(static_cast<double>((*screen)->refresh_ns()), 1e9 / 120, 1e4);
}

TEST_F(KmsScreen, HidesTheCursorAndColourTables) {
  card_.set_colour_table();
  ASSERT_TRUE(card_.shows_cursor());
  const auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  EXPECT_FALSE(card_.shows_cursor());
  EXPECT_EQ(card_.state().at("51.GAMMA_LUT"), "0");
}

TEST_F(KmsScreen, LeavesTheCardAsItWas) {
  card_.set_colour_table();
  const auto before = card_.state();
  {
    auto screen = Screen::open(settings());
    ASSERT_TRUE(screen) << screen.error().what;
    ASSERT_TRUE(show(**screen, Square()));
    EXPECT_NE(card_.state(), before);
  }
  EXPECT_EQ(card_.state(), before);
  EXPECT_EQ(card_.lit_mode("HDMI-A-1"), "640x480@60");
  EXPECT_EQ(card_.framebuffers(), 0);
}

TEST_F(KmsScreen, LeavesADisplayDarkThatWasDark) {
  card_.plug_in("DP-1", "OTHER", {timing(1024, 768, 60)});
  const auto before = card_.state();
  auto wanted = settings();
  wanted.connector = "OTHER";
  {
    auto screen = Screen::open(wanted);
    ASSERT_TRUE(screen) << screen.error().what;
    ASSERT_TRUE(show(**screen, Square()));
    EXPECT_EQ(card_.lit_mode("DP-1"), "1024x768@60");
    EXPECT_EQ(count(card_.scanned("DP-1"), kOrange), 100 * 100);
    EXPECT_EQ(card_.lit_mode("HDMI-A-1"), "640x480@60") << "the other one is left alone";
    EXPECT_TRUE(card_.shows_cursor());
  }
  EXPECT_EQ(card_.state(), before);
}

TEST_F(KmsScreen, ComesBackToADisplayThatWasUnplugged) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  ASSERT_TRUE(show(**screen, Square()));
  card_.unplug("HDMI-A-1");
  const auto lost = show_until(**screen, false);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, Errc::timeout);
  EXPECT_THAT(lost.error().what, HasSubstr("'HDMI-A-1' is unplugged"));
  EXPECT_EQ(card_.lit_mode("HDMI-A-1"), "") << "dark";
  const int probes = card_.probes();
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(show(**screen, Square()));
  EXPECT_EQ(card_.probes(), probes) << "an absent display is not asked";

  card_.plug_in("HDMI-A-1", "ANOTHER", {timing(1024, 768, 75)});
  ASSERT_TRUE(show_until(**screen, true));
  EXPECT_EQ(card_.lit_mode("HDMI-A-1"), "1024x768@75") << "a mode of the new display";
  EXPECT_EQ(count(card_.scanned("HDMI-A-1"), kOrange), 100 * 100);
}

TEST_F(KmsScreen, WaitsForADisplayThatFits) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  card_.unplug("HDMI-A-1");
  ASSERT_FALSE(show_until(**screen, false));
  card_.plug_in("HDMI-A-1", "TOO SMALL", {timing(640, 480, 60)});
  Result<Flip> refused = show(**screen, Square());
  for (const auto limit = Deadline::in(20s);
       !refused && refused.error().what.find("TOO SMALL") == std::string::npos && !limit.passed();)
    refused = show(**screen, Square());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::timeout);
  EXPECT_THAT(refused.error().what, HasSubstr("there is no mode 1024x768"));
  card_.plug_in("HDMI-A-1", "EPSON PJ", {timing(1024, 768, 60)});
  EXPECT_TRUE(show_until(**screen, true));
}

TEST_F(KmsScreen, ScalesThePictureIfTheCardCan) {
  card_.set({.can_scale = true});
  auto wanted = settings();
  wanted.mode = "1920x1080";
  auto screen = Screen::open(wanted);
  ASSERT_TRUE(screen) << screen.error().what;
  ASSERT_TRUE(show(**screen, Square()));
  EXPECT_EQ(card_.lit_mode("HDMI-A-1"), "1920x1080@60");
  EXPECT_EQ(card_.state().at("61.CRTC_W"), "1920");
}

TEST_F(KmsScreen, SubFramesAreNotScaled) {
  card_.set({.can_scale = true});
  auto wanted = settings();
  wanted.mode = "1920x1080";
  wanted.may_scale = false;
  const Error error = refusal(wanted);
  EXPECT_EQ(error.code, Errc::bad_config);
  EXPECT_THAT(error.what, HasSubstr("sub-frames cannot be scaled"));
}

TEST_F(KmsScreen, ACardThatNeverFlipsIsATimeoutNotAHang) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  card_.set({.never_flips = true});
  for (int i = 0; i < 2; ++i) {
    const auto late = (*screen)->show(Square().pixels.view(), Square().region, Deadline::in(20ms));
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().code, Errc::timeout);
  }
  card_.set({});
  EXPECT_TRUE(show_until(**screen, true));
}

TEST_F(KmsScreen, ACardThatHangsEndsTheScreen) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  card_.set({.never_flips = true});
  const Square square;
  auto shown = show(**screen, square);
  EXPECT_EQ(shown.error().code, Errc::disconnected) << "after the five seconds of this test";
  EXPECT_THAT(shown.error().what, HasSubstr("stopped to show pictures"));
}

TEST_F(KmsScreen, ACardThatIsPulledOutEndsTheScreen) {
  auto screen = Screen::open(settings());
  ASSERT_TRUE(screen) << screen.error().what;
  card_.set({.flip_fails = ENODEV});
  const auto lost = show(**screen, Square());
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, Errc::disconnected);
}

TEST_F(KmsScreen, SaysWhatAPersonCanDoWhereItIsNotPermitted) {
  card_.set({.open_fails = EACCES});
  EXPECT_EQ(refusal(settings()).code, Errc::bad_config);
  EXPECT_THAT(refusal(settings()).what,
              AllOf(HasSubstr("'/dev/dri/card0' may not be opened"), HasSubstr("group video")));
}

TEST_F(KmsScreen, SaysThatADesktopHasTheCard) {
  card_.set({.has_other_master = true});
  EXPECT_EQ(refusal(settings()).code, Errc::unavailable);
  EXPECT_THAT(refusal(settings()).what,
              AllOf(HasSubstr("another program shows pictures on '/dev/dri/card0'"),
                    HasSubstr("X, Wayland"), HasSubstr("systemctl isolate")));
  EXPECT_EQ(card_.lit_mode("HDMI-A-1"), "640x480@60");
}

TEST_F(KmsScreen, TwoCannotHaveOneCard) {
  auto first = Screen::open(settings());
  ASSERT_TRUE(first) << first.error().what;
  EXPECT_THAT(refusal(settings()).what, HasSubstr("another program shows pictures"));
  first->reset();
  EXPECT_TRUE(Screen::open(settings()));
}

TEST_F(KmsScreen, SaysWhatADriverCannotDo) {
  using Faults = test::EmulatedCard::Faults;
  for (const auto& [faults, what] :
       {std::pair(Faults{.has_atomic = false}, "atomic mode setting"),
        std::pair(Faults{.has_dumb_buffers = false}, "buffers that the processor can write"),
        std::pair(Faults{.has_monotonic_times = false}, "time stamps of CLOCK_MONOTONIC"),
        std::pair(Faults{.has_displays = false}, "displays")}) {
    card_.set(faults);
    EXPECT_EQ(refusal(settings()).code, Errc::bad_config);
    EXPECT_THAT(refusal(settings()).what, HasSubstr(what));
  }
}

TEST_F(KmsScreen, ListsTheConnectorsWhereNoneOrSeveralFit) {
  auto wanted = settings();
  wanted.connector = "HDMI-A-9";
  EXPECT_THAT(refusal(wanted).what,
              HasSubstr("there is no display 'HDMI-A-9'; the connectors are 'HDMI-A-1' (EPSON PJ, "
                        "1920x1080@60), 'DP-1' (empty)"));
  card_.plug_in("DP-1", "DELL", {timing(1024, 768, 60)});
  EXPECT_EQ(refusal(settings()).code, Errc::bad_config);
  EXPECT_THAT(refusal(settings()).what, HasSubstr("'DP-1' (DELL, 1024x768@60)"));
}

TEST_F(KmsScreen, ListsTheModesWhereNoneFits) {
  auto wanted = settings();
  wanted.mode = "800x600";
  EXPECT_THAT(refusal(wanted).what, AllOf(HasSubstr("'HDMI-A-1'"), HasSubstr("1024x768@120")));
}

TEST_F(KmsScreen, NamesTheModeThatACardRefuses) {
  card_.set({.most_clock_khz = 80'000});
  const auto refused = refusal(settings());
  EXPECT_EQ(refused.code, Errc::unavailable);
  EXPECT_THAT(refused.what, HasSubstr("refuses the mode 1024x768@120 for 'HDMI-A-1'"));
  auto wanted = settings();
  wanted.mode = "1920x1080";
  card_.set({});
  EXPECT_THAT(refusal(wanted).what, HasSubstr("with the picture of 1024x768 pixels scaled"));
  EXPECT_EQ(card_.lit_mode("HDMI-A-1"), "640x480@60") << "nothing was changed";
}

TEST(AKmsScreen, WithoutACardSaysSo) {
  const auto refused = Screen::open({.width_px = 1024, .height_px = 768, .rate_hz = 60});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unavailable);
  EXPECT_THAT(refused.error().what, HasSubstr("there is no graphics card"));
  const auto other = Screen::open({.card = "/dev/dri/card7", .width_px = 1024, .height_px = 768});
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().what, HasSubstr("'/dev/dri/card7' cannot be opened"));
}

}  // namespace
}  // namespace handcast::renderer::kms
