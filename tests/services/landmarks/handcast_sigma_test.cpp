// SPDX-License-Identifier: Apache-2.0
// The sigmas of handcast's model, as the detector publishes them, against the twin's truth.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "ipc/msg/owned.hpp"
#include "services/lab/training/trial.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"

namespace handcast::landmarks {
namespace {

using training::Trial;
using training::Trials;
constexpr int kImages = 60;  ///< of each motion

/// How far off a coordinate of a landmark is, and the sigma that came with it.
struct Coordinate {
  float error_px, sigma_px;
};

/// The detector shown the twin's images of hands and trackers it was not trained on; each twice,
/// because the second detection is what a stream shows.
class HandcastSigma : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    rig_.landmarks.backend = "handcast";
    const auto detector = open_detector(rig_, calib::reference_rig(), 0);
    ASSERT_TRUE(detector) << detector.error().what;
    for (const char* motion :
         {"builtin:fist", "builtin:pinch", "builtin:open_close", "builtin:rotate"}) {
      auto trials = Trials::open(motion, 3);
      ASSERT_TRUE(trials) << trials.error().what;
      for (int i = 0; i < kImages; ++i) detect(**detector, trials->make(i, kImages).value());
    }
  }
  static void TearDownTestSuite() { seen_.clear(); }

  /// Of the coordinates, how many are at most `sigmas` times their sigma off, had the sigmas been
  /// `factor` times as large.
  static double share_within(double sigmas, double factor = 1) {
    const auto within = std::ranges::count_if(
        seen_, [&](const Coordinate& c) { return c.error_px <= sigmas * factor * c.sigma_px; });
    return static_cast<double>(within) / static_cast<double>(seen_.size());
  }

  static inline std::vector<Coordinate> seen_;

 private:
  static void detect(Detector& detector, const Trial& trial) {
    const auto& camera = calib::reference_rig().camera;
    msg::Owned<msg::CameraFrame> frame(msg::CameraFrame::bytes(camera.width_px, camera.height_px));
    frame->width_px = trial.image.width();
    frame->height_px = trial.image.height();
    std::ranges::copy(trial.image.pixels(), frame->pixels());
    Hints hints;
    hints[static_cast<std::size_t>(trial.side)] = undistorted(camera, trial.tracker_px);
    for (const bool counts : {false, true}) {
      frame->header = {id_, static_cast<std::int64_t>(++id_) * 5'000'000, 0};
      const auto found = detector.detect(*frame, hints, Deadline::in(std::chrono::seconds(60)));
      ASSERT_TRUE(found) << found.error().what;
      const auto* hand = found->find(trial.side);
      if (counts && hand) keep(*hand, undistorted(camera, trial.truth_px));
    }
  }

  static void keep(const msg::HandLandmarks& hand, const Points& truth_px) {
    for (std::size_t i = 0; i < truth_px.size(); ++i) {
      const auto& point = hand.points[i];
      seen_.push_back({std::abs(point.x_px - truth_px[i].x), point.sigma_px});
      seen_.push_back({std::abs(point.y_px - truth_px[i].y), point.sigma_px});
    }
  }

  static inline config::Rig rig_;
  static inline std::uint64_t id_ = 0;
};

TEST_F(HandcastSigma, IsSaidOfEveryLandmark) {
  EXPECT_GT(seen_.size(), 3u * kImages * 2 * msg::kLandmarks) << "hands were found";
  EXPECT_TRUE(std::ranges::all_of(
      seen_, [](const Coordinate& c) { return c.sigma_px > 0 && c.sigma_px < 200; }));
}

TEST_F(HandcastSigma, HoldsTheErrorAsOftenAsAStandardDeviationShould) {
  // Of a Laplace distribution 76 and 94 %, of a normal one 68 and 95 %; on images as clean as these
  // the network is more careful than that.
  EXPECT_GT(share_within(1), 0.76);
  EXPECT_LT(share_within(1), 0.95);
  EXPECT_GT(share_within(2), 0.96);
  EXPECT_TRUE(share_within(1, 1.6) > 0.95 && share_within(2, 1 / 1.6) < 0.96)
      << "and a sigma that is off by that would be noticed";
}

TEST_F(HandcastSigma, IsLargerWhereTheErrorIs) {
  auto sorted = seen_;
  std::ranges::sort(sorted, {}, &Coordinate::sigma_px);
  const std::size_t fifth = sorted.size() / 5;
  const auto rms_px = [&](std::size_t from) {
    double sum = 0;
    for (std::size_t i = from; i < from + fifth; ++i)
      sum += sorted[i].error_px * sorted[i].error_px;
    return std::sqrt(sum / static_cast<double>(fifth));
  };
  EXPECT_GT(rms_px(2 * fifth), 1.1 * rms_px(0)) << "the middle fifth";
  EXPECT_GT(rms_px(4 * fifth), 2 * rms_px(0)) << "the highest";
}

}  // namespace
}  // namespace handcast::landmarks
