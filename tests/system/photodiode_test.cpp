// SPDX-License-Identifier: Apache-2.0
// A photodiode in the light of the twin, on a sound card that is emulated below ALSA's library:
// `handcast calibrate --photodiode` in a whole rig.
#include <gmock/gmock.h>

#include <cstdlib>
#include <deque>
#include <filesystem>
#include <optional>

#include "config/rig.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/services/tools/calibrate/sound/emulated_sound_card.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The voltage of a photodiode in the light of a rig that comes `late_ns` after it is reported.
/// Used by one thread.
class Photodiode {
 public:
  Photodiode(std::string rig, std::int64_t late_ns, double rate_hz)
      : rig_(std::move(rig)), late_ns_(late_ns), period_ns_(seconds_to_ns(1 / rate_hz)) {}

  /// At a time of CLOCK_MONOTONIC that is over. The frames until then have been published if
  /// `late_ns` is more than the projector's delay of publishing.
  double voltage_at(std::int64_t time_ns) {
    take_frames();
    double level = 0;
    for (const auto& frame : frames_) {
      if (frame.from_ns > time_ns - late_ns_) break;
      level = frame.level;
    }
    return 0.05 + 0.2 * level;
  }

 private:
  struct Frame {
    std::int64_t from_ns = 0;
    double level = 0;  ///< 0..1
  };

  void take_frames() {
    constexpr std::int64_t kEvery_ns = 1'000'000, kRetry_ns = 200'000'000;
    const auto time_ns = now_ns();
    if (time_ns < next_ns_) return;
    next_ns_ = time_ns + kEvery_ns;
    if (!light_) {
      next_ns_ = time_ns + kRetry_ns;
      auto opened = client::open_stream<msg::Projection>(rig_, "projection.frames");
      if (!opened) return;
      light_.emplace(std::move(*opened));
    }
    while (const auto shown = light_->next(Deadline::now()))
      frames_.push_back({(*shown)->lit_ns - period_ns_ / 2, level_of(**shown)});
    while (frames_.size() > 40) frames_.pop_front();
  }

  /// In the middle of the picture; hands count as dark.
  static double level_of(const msg::Projection& shown) {
    if (shown.test_picture == 0 || shown.region_height_px == 0) return 0;
    const auto middle =
        (shown.region_height_px / 2) * shown.region_width_px + shown.region_width_px / 2;
    return static_cast<double>(shown.pixels()[middle] & 0xff) / 255;
  }

  std::string rig_;
  std::int64_t late_ns_, period_ns_, next_ns_ = 0;
  std::optional<client::Stream<msg::Projection>> light_;
  std::deque<Frame> frames_;
};

class WholeRigWithAPhotodiode : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
    ::setenv("HANDCAST_SCOPE", scratch_.path().c_str(), 1);
    fs::copy_file("config/rigs/twin.toml", rig_file());
  }
  void TearDown() override {
    ::unsetenv("HANDCAST_SCOPE");
    SystemTest::TearDown();
  }
  std::string rig_file() const { return scratch_.path() / "twin.toml"; }
  Outcome measure(const std::string& device) const {
    return handcast({"calibrate", rig_file(), "light", "--yes", "--apply", "--photodiode", device,
                     "--most-s", "150", "--set", "observer.enabled=false", "--set",
                     "camera.rate_hz=30", "--set", "landmarks.backend=twin"});
  }
};

TEST_F(WholeRigWithAPhotodiode, TheDelayOfTheLightIsHeardAndWritten) {
  constexpr double kLate_ms = 40, kProjector_hz = 57;  // as services/tools/calibrate runs the twin
  Photodiode diode("twin", ms_to_ns(kLate_ms), kProjector_hz);
  const test::EmulatedSoundCard card(
      [&](std::int64_t time_ns) { return diode.voltage_at(time_ns); });
  const auto before = config::load_rig(rig_file(), {});
  ASSERT_TRUE(before) << before.error().what;
  const auto outcome = measure("photodiode");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(outcome.log, HasSubstr("after the reported time"));
  const auto after = config::load_rig(rig_file(), {});
  ASSERT_TRUE(after) << after.error().what;
  EXPECT_NEAR(after->projector.latency_ms - before->projector.latency_ms, kLate_ms, 2);
}

TEST_F(WholeRigWithAPhotodiode, ADiodeInTheDarkIsToldInASentence) {
  // With noise of 0.1 % of full scale: an even signal has no changes at all.
  const test::EmulatedSoundCard card(
      [](std::int64_t time_ns) { return 0.05 + 1e-4 * static_cast<double>(time_ns % 11); });
  const auto outcome = measure("photodiode");
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(last_line(outcome.log),
              HasSubstr("handcast calibrate: light: the photodiode does not see the light"));
  EXPECT_FALSE(fs::exists(scratch_.path() / "twin_calibration.toml"));
}

}  // namespace
}  // namespace handcast::system_test
