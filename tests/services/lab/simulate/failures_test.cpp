// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "ipc/base/clock.hpp"
#include "services/lab/simulate/simulation.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

/// The effect of each fault of the twin on the cascade, and the time of recovery, compared with the
/// same run without the fault. The limits are the measured figures (config/rigs/twin.toml, seed 1)
/// with a margin.
namespace handcast::simulate {
namespace {

using Settings = std::vector<std::string>;

constexpr double kFaultFrom_s = 0.8;
constexpr double kEnd_s = 2.0;
constexpr const char* kFrom = "0.8";

/// One projector frame of a run.
struct Moment {
  double seconds = 0;
  int hands = 0;
  double worst_px = 0;  ///< mean error of the corrected landmarks of the worst hand
  bool finite = true;
};

/// One drawn frame of a run.
struct Light {
  double seconds = 0;
  int lit_px = 0;      ///< projector pixels with light
  int changed_px = 0;  ///< pixels lit either now or in the last drawn frame, but not in both
  int foldovers = 0;
  double sum = 0;  ///< sum of all colour channels
};

struct Run {
  std::vector<Moment> moments;
  std::vector<Light> lights;
};

config::Rig rig_with(const std::string& motion, Settings settings) {
  settings.push_back("twin.motion=builtin:" + motion);
  auto rig = config::load_rig(source_root() / "config/rigs/twin.toml", plain("twin", settings));
  EXPECT_TRUE(rig) << rig.error().what;
  return *rig;
}

Moment moment_of(const Tick& tick, const twin::Twin& world) {
  Moment moment{ns_to_seconds(tick.display_ns)};
  for (const auto& hand : tick.hands) {
    const auto truth = world.landmarks(hand.side, tick.display_ns);
    for (const auto& point : hand.corrected)
      moment.finite = moment.finite && std::isfinite(point.x) && std::isfinite(point.y);
    if (!truth) continue;
    double sum_px = 0;
    for (std::size_t i = 0; i < truth->size(); ++i)
      sum_px += glm::length(hand.corrected[i] - (*truth)[i]);
    moment.worst_px = std::max(moment.worst_px, sum_px / static_cast<double>(truth->size()));
    ++moment.hands;
  }
  return moment;
}

/// Compares the lit pixels of a frame with those of the frame before.
class LightMeter {
 public:
  Light measure(const Tick& tick) {
    const auto& frame = *tick.frame;
    std::vector<bool> lit(static_cast<std::size_t>(frame.colour.width) *
                          static_cast<std::size_t>(frame.colour.height));
    Light light{ns_to_seconds(tick.display_ns), 0, 0, frame.foldovers, 0};
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x)
        if (const std::uint32_t colour = frame.colour.row(y)[x]; colour >> 24) {
          lit[static_cast<std::size_t>(y * frame.colour.width + x)] = true;
          ++light.lit_px;
          light.sum += (colour & 255) + (colour >> 8 & 255) + (colour >> 16 & 255);
        }
    for (std::size_t i = 0; i < before_.size(); ++i) light.changed_px += lit[i] != before_[i];
    before_ = std::move(lit);
    return light;
  }

 private:
  std::vector<bool> before_;
};

/// Runs the rig until kEnd_s and draws every `draw_every`-th frame (0: none).
Run run_through(const std::string& motion, const Settings& settings, int draw_every = 0) {
  const auto rig = rig_with(motion, settings);
  const auto calibration = calib::reference_rig();
  const auto world = twin::Twin::create(rig, calibration);
  EXPECT_TRUE(world) << world.error().what;
  const auto pipeline = renderer::Pipeline::create(rig.cascade, rig.content, rig.hand, calibration);
  EXPECT_TRUE(pipeline) << pipeline.error().what;
  const auto feed = make_twin_feed(**world);
  Simulation simulation(rig, calibration, **pipeline, *feed, draw_every);
  Run run;
  LightMeter meter;
  while (simulation.now_ns() < seconds_to_ns(kEnd_s))
    simulation.step([&](const Tick& tick) {
      run.moments.push_back(moment_of(tick, **world));
      if (tick.frame && run.moments.back().seconds > 0.4) run.lights.push_back(meter.measure(tick));
    });
  return run;
}

/// The run without a fault, which is made on the first call.
const Run& clean_run(const std::string& motion, int draw_every = 0) {
  static std::map<std::pair<std::string, int>, Run> runs;
  const auto [run, is_new] = runs.try_emplace({motion, draw_every});
  if (is_new) run->second = run_through(motion, {}, draw_every);
  return run->second;
}

/// Effect of a fault, compared with the same run without it. All but `finite` from its start on.
struct Damage {
  bool finite = true;
  double clean_px = 0;  ///< mean error of the run without the fault
  double worst_px = 0;  ///< largest mean error of a hand
  /// Largest changes of that error between successive projector frames: the light leaves the hand,
  /// or is back on it at once.
  /// @{
  double away_px = 0, back_px = 0;
  /// @}
  /// Time from the end of the fault until the error stays within 2 px of the clean run's.
  double recovery_ms = 0;
  int frames_without_hand = 0;  ///< frames that lack a hand of the clean run
};

Damage damage_of(const Run& clean, const Run& faulty, double fault_end_s) {
  constexpr double kGood_px = 2;
  Damage damage;
  double last_bad_s = fault_end_s, before_px = 0;
  std::size_t count = 0;
  EXPECT_EQ(clean.moments.size(), faulty.moments.size());
  for (std::size_t i = 0; i < clean.moments.size(); ++i) {
    const Moment &good = clean.moments[i], &bad = faulty.moments[i];
    damage.finite = damage.finite && bad.finite;
    if (good.seconds < kFaultFrom_s) {
      before_px = bad.worst_px;
      continue;
    }
    damage.clean_px += good.worst_px;
    ++count;
    damage.worst_px = std::max(damage.worst_px, bad.worst_px);
    if (bad.hands == good.hands) {
      damage.away_px = std::max(damage.away_px, bad.worst_px - before_px);
      damage.back_px = std::max(damage.back_px, before_px - bad.worst_px);
    }
    before_px = bad.worst_px;
    damage.frames_without_hand += bad.hands < good.hands;
    if (bad.hands < good.hands || bad.worst_px > good.worst_px + kGood_px)
      last_bad_s = std::max(last_bad_s, bad.seconds);
  }
  damage.clean_px /= static_cast<double>(count);
  damage.recovery_ms = 1e3 * (last_bad_s - fault_end_s);
  return damage;
}

/// A fault and the limits of its effect.
struct Case {
  std::string name, motion;
  Settings settings;
  double lasting_s;
  double worst_px, away_px, back_px, recovery_ms;
};

std::ostream& operator<<(std::ostream& out, const Case& fault) {
  return out << fault.name << " on " << fault.motion;
}

class Failure : public testing::TestWithParam<Case> {};

TEST_P(Failure, IsBoundedAndOver) {
  const auto& fault = GetParam();
  const auto damage = damage_of(clean_run(fault.motion), run_through(fault.motion, fault.settings),
                                kFaultFrom_s + fault.lasting_s);
  fmt::print(
      "[ failure  ] {:26} {:10} clean {:5.2f} px, worst {:6.2f} px, steps {:5.2f} px away and "
      "{:5.2f} back, good again after {:6.1f} ms, {} frames without a hand\n",
      fault.name, fault.motion, damage.clean_px, damage.worst_px, damage.away_px, damage.back_px,
      damage.recovery_ms, damage.frames_without_hand);
  EXPECT_TRUE(damage.finite);
  EXPECT_LE(damage.worst_px, fault.worst_px);
  EXPECT_LE(damage.away_px, fault.away_px);
  EXPECT_LE(damage.back_px, fault.back_px);
  EXPECT_LE(damage.recovery_ms, fault.recovery_ms);
}

Settings lasting(const std::string& path, const std::string& lasting_s) {
  return {path + "_at_s=" + kFrom, path + "_s=" + lasting_s};
}

/// While the tracker is silent or has just jumped, only landmarks are used, which causes the worst
/// errors of a shaken hand. Recovery takes two detections after a fault of the detector (its age
/// and its interval), and three samples plus their age after a fault of the tracker. The light of a
/// shaken hand, 26 px off, is then back at once: cascade.filter.blend_px holds back 8 px of a jump.
std::vector<Case> cases() {
  const auto detector_lost = lasting("twin.detector.lost", "0.3"),
             detector_wrong = lasting("twin.detector.wrong_finger", "0.2");
  const auto wrong = lasting("twin.tracker.wrong_finger", "0.2"),
             frozen = lasting("twin.tracker.frozen", "0.2");
  const auto lost = lasting("twin.tracker.lost", "0.2"),
             swapped = lasting("twin.tracker.swapped", "0.2");
  return {
      {"detector_lost", "wave", detector_lost, 0.3, 8, 2, 2, 33},
      {"detector_lost", "two_hands", detector_lost, 0.3, 8, 2, 2, 33},
      {"detector_lost", "shake", detector_lost, 0.3, 11, 2, 2, 33},
      {"detector_wrong_finger", "wave", detector_wrong, 0.2, 3.3, 1, 1, 5},
      {"detector_wrong_finger", "two_hands", detector_wrong, 0.2, 3, 1, 1, 5},
      {"detector_wrong_finger", "shake", detector_wrong, 0.2, 11, 2, 2, 5},
      {"tracker_wrong_finger", "wave", wrong, 0.2, 8, 1.5, 1.5, 60},
      {"tracker_wrong_finger", "two_hands", wrong, 0.2, 8, 1.5, 1.5, 60},
      {"tracker_wrong_finger", "shake", wrong, 0.2, 30, 3, 18, 75},
      {"tracker_frozen", "wave", frozen, 0.2, 8, 1.5, 1.5, 60},
      {"tracker_frozen", "two_hands", frozen, 0.2, 8, 1.5, 1.5, 60},
      {"tracker_frozen", "shake", frozen, 0.2, 35, 3, 18, 75},
      {"tracker_lost", "wave", lost, 0.2, 8, 1.5, 1.5, 60},
      {"tracker_lost", "two_hands", lost, 0.2, 8, 1.5, 1.5, 60},
      {"tracker_lost", "shake", lost, 0.2, 35, 3, 18, 75},
      {"tracker_swapped", "wave", swapped, 0.2, 3, 1, 1, 5},
      {"tracker_swapped", "two_hands", swapped, 0.2, 3, 1, 1, 5},
      {"tracker_swapped", "shake", swapped, 0.2, 11, 2, 2, 5},
  };
}

INSTANTIATE_TEST_SUITE_P(All, Failure, testing::ValuesIn(cases()), [](const auto& test) {
  return test.param.name + "_on_" + test.param.motion;
});

/// A fault that lasts for the whole run, which is compared with the run without it.
struct Lasting {
  std::string name, motion;
  Settings settings;
  double times;  ///< upper limit of its mean error, relative to the run without it
};
class LastingFailure : public testing::TestWithParam<Lasting> {};

double mean_px(const Run& run) {
  double sum = 0;
  std::size_t count = 0;
  for (const auto& moment : run.moments)
    if (moment.seconds > 0.4 && moment.hands > 0) sum += moment.worst_px, ++count;
  return count ? sum / static_cast<double>(count) : 0;
}

TEST_P(LastingFailure, MakesTheErrorLargerByNoMoreThan) {
  const auto& fault = GetParam();
  const auto& clean = clean_run(fault.motion);
  const auto faulty = run_through(fault.motion, fault.settings);
  const double times = mean_px(faulty) / mean_px(clean);
  fmt::print("[ lasting  ] {:26} {:10} {:5.2f} px, {:5.2f} px with it: {:.2f} times\n", fault.name,
             fault.motion, mean_px(clean), mean_px(faulty), times);
  for (const auto& moment : faulty.moments) ASSERT_TRUE(moment.finite) << moment.seconds;
  EXPECT_LE(times, fault.times);
}

INSTANTIATE_TEST_SUITE_P(
    All, LastingFailure,
    testing::Values(
        Lasting{"tracker_10_ms_ahead", "wave", {"twin.tracker.clock_skew_ms=10"}, 1.3},
        Lasting{"tracker_10_ms_behind", "wave", {"twin.tracker.clock_skew_ms=-10"}, 1.6},
        Lasting{"detector_10_ms_ahead", "wave", {"twin.detector.clock_skew_ms=10"}, 4.5},
        Lasting{"detector_10_ms_behind", "wave", {"twin.detector.clock_skew_ms=-10"}, 4.5},
        Lasting{"outliers", "wave", {"twin.detector.outliers=0.05"}, 1.2},
        Lasting{"outliers", "still", {"twin.detector.outliers=0.05"}, 1.2}),
    [](const auto& test) { return test.param.name + "_on_" + test.param.motion; });

/// Motions that are difficult without any fault.
class HardMotion : public testing::TestWithParam<std::pair<std::string, double>> {};

TEST_P(HardMotion, KeepsEveryFrameFiniteAndTheErrorBounded) {
  const auto& [motion, most_px] = GetParam();
  const auto run = run_through(motion, {});
  double worst_px = 0;
  for (const auto& moment : run.moments) {
    ASSERT_TRUE(moment.finite) << moment.seconds;
    if (moment.seconds > 0.4) worst_px = std::max(worst_px, moment.worst_px);
  }
  fmt::print("[ motion   ] {:16} mean {:5.2f} px, worst frame {:5.2f} px\n", motion, mean_px(run),
             worst_px);
  EXPECT_LE(worst_px, most_px);
}

INSTANTIATE_TEST_SUITE_P(All, HardMotion,
                         testing::Values(std::pair("crossing", 3.5), std::pair("flip", 6.5),
                                         std::pair("fist", 7.0), std::pair("point_at_camera", 3.5),
                                         std::pair("enter_leave", 8.0), std::pair("reverse", 36.0),
                                         std::pair("cross_fingers", 8.0)),
                         [](const auto& test) { return std::string(test.param.first); });

/// A fault and the limits of its effect on the lit pixels between successive drawn frames. All are
/// relative to the lit pixels of the clean run.
struct Flash {
  std::string name, motion;
  Settings settings;
  double extra_change;  ///< most pixels that change in addition to those of the clean run
  double most_light;    ///< most lit pixels
  double least_light;   ///< fewest lit pixels
};
std::ostream& operator<<(std::ostream& out, const Flash& fault) {
  return out << fault.name << " on " << fault.motion;
}

class LightUnder : public testing::TestWithParam<Flash> {};

TEST_P(LightUnder, NeitherFlashesNorFolds) {
  const auto& fault = GetParam();
  constexpr int kDrawEvery = 16;
  const auto& clean = clean_run(fault.motion, kDrawEvery);
  const auto faulty = run_through(fault.motion, fault.settings, kDrawEvery);
  double extra = 0, most = 0, least = 9;
  int foldovers = 0;
  ASSERT_EQ(clean.lights.size(), faulty.lights.size());
  for (std::size_t i = 1; i < faulty.lights.size(); ++i) {
    const double whole = std::max(1, clean.lights[i].lit_px);
    extra = std::max(extra, (faulty.lights[i].changed_px - clean.lights[i].changed_px) / whole);
    most = std::max(most, faulty.lights[i].lit_px / whole);
    least = std::min(least, faulty.lights[i].lit_px / whole);
    foldovers += faulty.lights[i].foldovers;
  }
  fmt::print(
      "[ light    ] {:22} {:6} extra change {:.3f}, light {:.3f} to {:.3f} of the clean run's, {} "
      "fold-overs\n",
      fault.name, fault.motion, extra, least, most, foldovers);
  EXPECT_EQ(foldovers, 0);
  EXPECT_LE(extra, fault.extra_change);
  EXPECT_LE(most, fault.most_light);
  EXPECT_GE(least, fault.least_light);
}

Settings in_the_image(const std::string& what) {
  return {"twin.image." + what, std::string("twin.image.fault_at_s=") + kFrom,
          "twin.image.fault_s=0.2"};
}

INSTANTIATE_TEST_SUITE_P(
    All, LightUnder,
    testing::Values(
        Flash{"detector_lost", "wave", lasting("twin.detector.lost", "0.3"), 0.05, 1.05, 0.95},
        Flash{"detector_wrong_finger", "wave", lasting("twin.detector.wrong_finger", "0.2"), 0.05,
              1.05, 0.95},
        Flash{"tracker_wrong_finger", "wave", lasting("twin.tracker.wrong_finger", "0.2"), 0.1,
              1.06, 0.95},
        Flash{"tracker_frozen", "wave", lasting("twin.tracker.frozen", "0.2"), 0.1, 1.05, 0.95},
        Flash{"tracker_lost", "wave", lasting("twin.tracker.lost", "0.2"), 0.1, 1.05, 0.95},
        Flash{"tracker_swapped", "two_hands", lasting("twin.tracker.swapped", "0.2"), 0.05, 1.05,
              0.95},
        Flash{"dark", "still", in_the_image("dark=0.15"), 0.02, 1.02, 0.98},
        Flash{"half_dark", "still", in_the_image("dark=0.5"), 0.02, 1.02, 0.98},
        Flash{"saturated", "still", in_the_image("saturated=8"), 0.02, 1.03, 0.98},
        Flash{"all_white", "still", in_the_image("saturated=100"), 0.18, 1.15, 0.98},
        Flash{"small_holes", "still", in_the_image("holes=0.02"), 0.02, 1.02, 0.98},
        Flash{"holes", "still", in_the_image("holes=0.3"), 0.33, 1.02, 0.68},
        Flash{"covered", "still", in_the_image("covered=0.49"), 0.47, 1.02, 0.53},
        Flash{"face", "two_hands", in_the_image("face=true"), 0.05, 1.06, 0.97}),
    [](const auto& test) { return test.param.name; });

/// The camera image is black for a while: the light fades out slowly and returns without a flash.
class CoveredCamera : public testing::TestWithParam<std::pair<std::string, double>> {};

TEST_P(CoveredCamera, TakesTheLightLittleByLittleAndGivesItBack) {
  const auto& [motion, dark_s] = GetParam();
  constexpr int kDrawEvery = 8;
  constexpr double kStep_ms = kDrawEvery * 1e3 / 946, kFade_ms = 100, kReturn_ms = 30;
  const double end_s = kFaultFrom_s + dark_s;
  const auto& clean = clean_run(motion, kDrawEvery);
  const auto faulty =
      run_through(motion,
                  {"twin.image.dark=0", "twin.image.fault_at_s=" + std::string(kFrom),
                   fmt::format("twin.image.fault_s={}", dark_s)},
                  kDrawEvery);
  double before = 1, least = 1, last_dark = 1, most = 0, most_fall = 0, most_rise = 0,
         after_10_ms = 0;
  for (std::size_t i = 1; i < faulty.lights.size(); ++i) {
    const double seconds = faulty.lights[i].seconds,
                 level = faulty.lights[i].sum / clean.lights[i].sum;
    if (seconds < kFaultFrom_s + 0.01) after_10_ms = level;
    if (seconds < end_s) last_dark = level;
    if (seconds > end_s + 0.06) {
      EXPECT_NEAR(level, 1, 0.03) << seconds;
    }
    least = std::min(least, level);
    most = std::max(most, level);
    most_fall = std::max(most_fall, before - level);
    most_rise = std::max(most_rise, level - before);
    before = level;
  }
  fmt::print(
      "[ covered  ] {:6} for {:3.0f} ms: {:.2f} of its light after 10 ms, {:.2f} at the end; "
      "{:.2f} to {:.2f}; in a step of {:.1f} ms, {:.2f} less or {:.2f} more at most\n",
      motion, 1e3 * dark_s, after_10_ms, last_dark, least, most, kStep_ms, most_fall, most_rise);
  EXPECT_GT(after_10_ms, 0.9);
  EXPECT_LT(most_fall, 1.5 * kStep_ms / kFade_ms + 0.05);
  EXPECT_LT(most_rise, kStep_ms / kReturn_ms + 0.05);
  EXPECT_LT(most, 1.05);
  if (dark_s < 0.06) {
    EXPECT_GT(least, 0.35);
  } else {
    EXPECT_EQ(last_dark, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, CoveredCamera,
                         testing::Values(std::pair("still", 0.05), std::pair("wave", 0.4)),
                         [](const auto& test) {
                           return fmt::format("{}_for_{}_ms", test.param.first,
                                              std::lround(1e3 * test.param.second));
                         });

}  // namespace
}  // namespace handcast::simulate
