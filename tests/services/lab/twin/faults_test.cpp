// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <map>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/finger_pose.hpp"
#include "tests/services/lab/twin/world.hpp"

/// Each fault has its effect between its times, and none before and after.
namespace handcast::twin {
namespace {

constexpr config::Fault kAWhile{.at_s = 1, .lasting_s = 0.3};
constexpr std::uint64_t kSamples = 200;  // 1.8 s

bool same(const msg::HandPose& a, const msg::HandPose& b) {
  return std::memcmp(&a.joints, &b.joints, sizeof a.joints) == 0;
}
bool same(const msg::HandLandmarks& a, const msg::HandLandmarks& b) {
  return std::memcmp(&a.points, &b.points, sizeof a.points) == 0;
}

/// Calls `check(usual poses, faulty poses, whether the fault holds)` for 200 samples of two hands.
template <class Check>
void compare_trackers(const config::TwinTracker& settings, Check&& check) {
  auto rig = rig_with("builtin:two_hands");
  const auto usual = twin_of(rig);
  rig.twin.tracker = settings;
  const auto faulty = twin_of(rig);
  for (std::uint64_t k = 0; k < kSamples; ++k) {
    const bool during = kAWhile.holds(ns_to_seconds(usual->tracker_time_ns(k)));
    const auto a = usual->tracker_sample(k), b = faulty->tracker_sample(k);
    EXPECT_EQ(a.arrival_ns, b.arrival_ns) << "a fault delays nothing";
    EXPECT_EQ(a.poses.header.frame_id, b.poses.header.frame_id);
    EXPECT_EQ(usual->tracker_time_ns(k), faulty->tracker_time_ns(k));
    check(a.poses, b.poses, during);
  }
}

/// The same for the detections of every fifth camera frame.
template <class Check>
void compare_detectors(const config::TwinDetector& settings, Check&& check) {
  auto rig = rig_with("builtin:two_hands");
  const auto usual = twin_of(rig);
  rig.twin.detector = settings;
  const auto faulty = twin_of(rig);
  for (std::uint64_t n = 0; n < kSamples; ++n) {
    const auto origin_ns = usual->camera_origin_ns(5 * n);
    const auto a = usual->detect(n, 5 * n, origin_ns), b = faulty->detect(n, 5 * n, origin_ns);
    EXPECT_EQ(a.age_ns, b.age_ns);
    check(a.landmarks, b.landmarks, kAWhile.holds(ns_to_seconds(origin_ns)));
  }
}

TEST(Fault, HoldsFromItsBeginningUntilItsEnd) {
  EXPECT_FALSE(config::Fault{}.holds(0));
  EXPECT_FALSE(kAWhile.holds(0.999));
  EXPECT_TRUE(kAWhile.holds(1));
  EXPECT_TRUE(kAWhile.holds(1.299));
  EXPECT_FALSE(kAWhile.holds(1.3));
}

TEST(Fault, NothingIsWrongByDefault) {
  const config::Twin twin;
  for (const auto& fault : {twin.tracker.frozen, twin.tracker.lost, twin.tracker.wrong_finger,
                            twin.tracker.swapped, twin.detector.lost, twin.detector.wrong_finger})
    for (const double seconds : {0.0, 1.0, 1e6}) EXPECT_FALSE(fault.holds(seconds));
  compare_trackers({}, [](const msg::HandPoses& usual, const msg::HandPoses& now, bool) {
    ASSERT_EQ(now.count, 2u);
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(same(usual.hands[i], now.hands[i]));
  });
}

TEST(TrackerFault, FrozenItRepeatsItsLastPoseWithNewStamps) {
  msg::HandPoses last{};
  int frozen = 0;
  compare_trackers({.frozen = kAWhile},
                   [&](const msg::HandPoses& usual, const msg::HandPoses& now, bool during) {
                     EXPECT_EQ(usual.header.origin_ns, now.header.origin_ns);
                     ASSERT_EQ(now.count, 2u);
                     if (!during) last = usual;
                     for (int i = 0; i < 2; ++i) {
                       EXPECT_TRUE(same(during ? last.hands[i] : usual.hands[i], now.hands[i]))
                           << usual.header.frame_id;
                       EXPECT_EQ(now.hands[i].side, usual.hands[i].side);
                     }
                     frozen += during;
                   });
  EXPECT_NEAR(frozen, 0.3 * 110.6, 2);
}

TEST(TrackerFault, LostItGivesNoSamples) {
  compare_trackers({.lost = kAWhile},
                   [](const msg::HandPoses& usual, const msg::HandPoses& now, bool during) {
                     EXPECT_EQ(now.count, during ? 0u : 2u);
                     if (!during) {
                       EXPECT_TRUE(same(usual.hands[1], now.hands[1]));
                     }
                   });
}

TEST(TrackerFault, DecayingTheWristStaysAndTheFingersSinkTowardsTheRestPose) {
  auto rig = perfect_rig("builtin:open_close");
  rig.twin.tracker.decaying = {.at_s = 1, .lasting_s = 0.6};
  const auto twin = twin_of(rig);
  const auto reported = [&](std::uint64_t k) {
    return renderer::frames_of(*twin->tracker_sample(k).poses.find(Side::left));
  };
  const auto first = [&](double seconds) {
    std::uint64_t k = 0;
    while (ns_to_seconds(twin->tracker_time_ns(k)) < seconds) ++k;
    return k;
  };
  const auto last = reported(first(1) - 1);
  const double rest = flexion_of(rest_pose(Side::left, renderer::HandShape::mean()))[2][1];
  const double far = flexion_of(last)[2][1] - rest;
  ASSERT_GT(far, 0.5) << "the hand is half closed";
  for (const double later_s : {0.2, 0.4}) {
    const auto now = reported(first(1 + later_s));
    EXPECT_EQ(place(now[1]), place(last[1])) << "the wrist is frozen";
    EXPECT_NEAR((flexion_of(now)[2][1] - rest) / far, std::exp2(-later_s / 0.2), 0.06);
    EXPECT_NEAR(glm::distance(place(now[13]), place(now[14])),
                glm::distance(place(last[13]), place(last[14])), 1e-5);
  }
  const auto after = first(1.61);
  EXPECT_LT(glm::distance(place(reported(after)[15]),
                          place((*twin->joints(Side::left, twin->tracker_time_ns(after)))[15])),
            1e-5);
}

TEST(TrackerFault, MergedIndexAndMiddleAreOneFingerFromThePipOn) {
  compare_trackers({.drift_px = 0, .noise_mm = 0, .merged = kAWhile},
                   [](const msg::HandPoses&, const msg::HandPoses& now, bool during) {
                     for (int i = 0; i < 2; ++i) {
                       const auto frames = renderer::frames_of(now.hands[i]);
                       for (const int j : {8, 9, 10}) {
                         const auto apart_m = glm::distance(place(frames[j]), place(frames[j + 5]));
                         EXPECT_EQ(apart_m < 1e-6, during) << j;
                       }
                       EXPECT_GT(glm::distance(place(frames[7]), place(frames[12])), 0.01);
                     }
                   });
}

TEST(TrackerFault, TwoAtOnceBothHold) {
  compare_trackers({.frozen = {.at_s = 1.05, .lasting_s = 0.1}, .wrong_finger = kAWhile},
                   [tip = std::array<float, 3>{}](const msg::HandPoses& usual,
                                                  const msg::HandPoses& now, bool during) mutable {
                     const double seconds = ns_to_seconds(now.header.origin_ns);
                     const bool frozen = seconds >= 1.05 && seconds < 1.15;
                     const auto seen = now.hands[0].joints[during ? 15 : 10].position_m;
                     if (!frozen) tip = usual.hands[0].joints[10].position_m;
                     EXPECT_EQ(seen, tip) << seconds;
                   });
}

TEST(TrackerFault, WithTheWrongFingerIndexAndMiddleAreExchanged) {
  compare_trackers({.wrong_finger = kAWhile}, [](const msg::HandPoses& usual,
                                                 const msg::HandPoses& now, bool during) {
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < msg::kJoints; ++j) {
        int from = j;
        if (during && j >= 6 && j <= 15) from = j <= 10 ? j + 5 : j - 5;
        EXPECT_EQ(now.hands[i].joints[j].position_m, usual.hands[i].joints[from].position_m) << j;
      }
  });
}

TEST(TrackerFault, SwappedTheLeftHandIsTakenForTheRight) {
  compare_trackers({.swapped = kAWhile}, [](const msg::HandPoses& usual, const msg::HandPoses& now,
                                            bool during) {
    for (const Side side : {Side::left, Side::right}) {
      const Side taken_for = side == (during ? Side::left : Side::right) ? Side::right : Side::left;
      EXPECT_TRUE(same(*usual.find(side), *now.find(taken_for)));
    }
  });
}

TEST(TrackerFault, ASkewedClockChangesTheStampsAlone) {
  compare_trackers({.clock_skew_ms = -10},
                   [](const msg::HandPoses& usual, const msg::HandPoses& now, bool) {
                     EXPECT_EQ(now.header.origin_ns, usual.header.origin_ns - 10'000'000);
                     EXPECT_EQ(now.header.published_ns, usual.header.published_ns);
                     for (int i = 0; i < 2; ++i) EXPECT_TRUE(same(usual.hands[i], now.hands[i]));
                   });
}

TEST(DetectorFault, LostItFindsNothing) {
  int lost = 0;
  compare_detectors({.lost = kAWhile},
                    [&](const msg::Landmarks& usual, const msg::Landmarks& now, bool during) {
                      EXPECT_EQ(now.count, during ? 0u : 2u);
                      EXPECT_EQ(now.header.origin_ns, usual.header.origin_ns);
                      if (!during) {
                        EXPECT_TRUE(same(usual.hands[1], now.hands[1]));
                      }
                      lost += during;
                    });
  EXPECT_NEAR(lost, 0.3 * 105, 2);
}

TEST(DetectorFault, WithTheWrongFingerIndexAndMiddleAreExchanged) {
  compare_detectors({.wrong_finger = kAWhile}, [](const msg::Landmarks& usual,
                                                  const msg::Landmarks& now, bool during) {
    for (int i = 0; i < 2; ++i)
      for (int point = 0; point < msg::kLandmarks; ++point) {
        int from = point;
        if (during && point >= 5 && point <= 12) from = point <= 8 ? point + 4 : point - 4;
        EXPECT_EQ(now.hands[i].points[point].x_px, usual.hands[i].points[from].x_px) << point;
      }
  });
}

TEST(DetectorFault, ASkewedClockChangesTheStampsAlone) {
  compare_detectors({.clock_skew_ms = 10},
                    [](const msg::Landmarks& usual, const msg::Landmarks& now, bool) {
                      EXPECT_EQ(now.header.origin_ns, usual.header.origin_ns + 10'000'000);
                      EXPECT_EQ(now.header.published_ns, usual.header.published_ns);
                      EXPECT_TRUE(same(usual.hands[0], now.hands[0]));
                    });
}

/// Expects a tenth of the landmarks to be displaced, each by a distance between the two.
void expect_a_tenth_displaced(const config::TwinDetector& outliers, float nearest_px,
                              float farthest_px) {
  int thrown = 0, all = 0;
  compare_detectors(outliers, [&](const msg::Landmarks& usual, const msg::Landmarks& now, bool) {
    for (int i = 0; i < 2; ++i)
      for (int point = 0; point < msg::kLandmarks; ++point, ++all) {
        const auto &a = usual.hands[i].points[point], &b = now.hands[i].points[point];
        const float off_px = std::hypot(a.x_px - b.x_px, a.y_px - b.y_px);
        if (off_px == 0) continue;
        ++thrown;
        EXPECT_GT(off_px, nearest_px - 0.1f);
        EXPECT_LT(off_px, farthest_px + 0.1f);
      }
  });
  EXPECT_NEAR(thrown / double(all), 0.1, 0.01);
}

TEST(DetectorFault, OutliersAreTheAskedShareAndFarOff) {
  expect_a_tenth_displaced({.outliers = 0.1}, 40, 200);
}

TEST(DetectorFault, NearOutliersAreTheAskedShareAndNear) {
  expect_a_tenth_displaced({.near_outliers = 0.1}, 5, 40);
}

TEST(DetectorFault, MergedIndexAndMiddleAreInOnePlace) {
  compare_detectors({.merged = kAWhile}, [](const msg::Landmarks& usual, const msg::Landmarks& now,
                                            bool during) {
    for (int i = 0; i < 2; ++i)
      for (const int point : {6, 7, 8}) {
        const auto &index = now.hands[i].points[point], &middle = now.hands[i].points[point + 4];
        const float mean_px =
            (usual.hands[i].points[point].x_px + usual.hands[i].points[point + 4].x_px) / 2;
        EXPECT_EQ(index.x_px == middle.x_px && index.y_px == middle.y_px, during) << point;
        if (during) {
          EXPECT_FLOAT_EQ(index.x_px, mean_px);
        }
      }
  });
}

// --- images ---

using renderer::Image;
// Frames at 525 Hz: 0.95, 1.07 and 1.33 s.
constexpr std::uint64_t kBefore = 500, kDuring = 560, kAfter = 700;

/// The images of a still hand at kBefore, kDuring and kAfter.
std::map<std::uint64_t, Image<std::uint8_t>> pictures(const config::TwinImage& settings) {
  auto rig = rig_with("builtin:still");
  rig.twin.image = settings;
  const auto twin = twin_of(rig);
  std::map<std::uint64_t, Image<std::uint8_t>> images;
  for (const auto k : {kBefore, kDuring, kAfter}) {
    Image<std::uint8_t> image(720, 540);
    twin->camera_image(k, image.view());
    images[k] = std::move(image);
  }
  return images;
}

/// The image at kDuring without and with the fault. Checks that both are the same before and after.
std::pair<Image<std::uint8_t>, Image<std::uint8_t>> usual_and_faulty(config::TwinImage settings) {
  auto usual = pictures({});
  settings.fault = kAWhile;
  auto faulty = pictures(settings);
  for (const auto k : {kBefore, kAfter})
    EXPECT_EQ(usual[k].pixels(), faulty[k].pixels()) << "outside of the fault";
  EXPECT_NE(usual[kDuring].pixels(), faulty[kDuring].pixels());
  return {std::move(usual[kDuring]), std::move(faulty[kDuring])};
}

double mean_where_skin_was(const Image<std::uint8_t>& usual, const Image<std::uint8_t>& image,
                           bool skin) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 720; ++x)
      if (skin ? usual.at(x, y) > 90 : usual.at(x, y) < 15) sum += image.at(x, y), ++count;
  return sum / count;
}

TEST(ImageFault, DarkTakesTheLightAway) {
  const auto [usual, dark] = usual_and_faulty({.dark = 0.2});
  EXPECT_NEAR(mean_where_skin_was(usual, dark, true) / mean_where_skin_was(usual, usual, true), 0.2,
              0.01);
}

TEST(ImageFault, SaturatedIsWhiteAndLiftsTheBackground) {
  const auto [usual, white] = usual_and_faulty({.saturated = 6});
  EXPECT_GT(mean_where_skin_was(usual, white, true), 250);
  EXPECT_NEAR(mean_where_skin_was(usual, white, false) / mean_where_skin_was(usual, usual, false),
              6, 0.6);
}

TEST(ImageFault, HolesCoverTheAskedShareOfTheHand) {
  const auto [usual, torn] = usual_and_faulty({.holes = 0.3});
  int hand = 0, holes = 0;
  const auto wrist_y =
      static_cast<int>((*twin_of(rig_with("builtin:still"))->landmarks(Side::left, 0))[0].y);
  for (int y = 0; y < wrist_y; ++y)
    for (int x = 0; x < 720; ++x) {
      if (usual.at(x, y) < 60) continue;
      ++hand;
      holes += torn.at(x, y) < 40;
    }
  EXPECT_NEAR(holes / double(hand), 0.3, 0.12)
      << "share of the visible surface; the setting is the share of the whole surface";
}

TEST(ImageFault, HolesMoveWithTheHand) {
  auto rig = rig_with("builtin:reverse");
  rig.twin.image.holes = 0.3;
  rig.twin.image.noise = 0;
  const auto twin = twin_of(rig);
  const auto bright_along_bones = [&](std::uint64_t k) {
    Image<std::uint8_t> image(720, 540);
    twin->camera_image(k, image.view());
    std::vector<bool> bright;
    const auto points = *twin->landmarks(Side::left, twin->camera_origin_ns(k));
    for (int i = 1; i < msg::kLandmarks; ++i)
      for (const float along : {0.2f, 0.4f, 0.6f, 0.8f}) {
        const auto px = glm::mix(points[i % 4 == 1 ? 0 : i - 1], points[i], along);
        bright.push_back(image.at(int(px.x), int(px.y)) > 50);
      }
    return bright;
  };
  const auto first = bright_along_bones(0);
  for (const std::uint64_t k : {37, 74, 111, 148}) {
    const auto now = bright_along_bones(k);
    int same_as_first = 0;
    for (std::size_t i = 0; i < now.size(); ++i) same_as_first += now[i] == first[i];
    EXPECT_GE(same_as_first, 68) << "of 80, frame " << k;
  }
}

TEST(ImageFault, CoveredHidesTheLeftOfTheImage) {
  const auto [usual, covered] = usual_and_faulty({.covered = 0.5});
  for (int y = 0; y < 540; y += 9) {
    for (int x = 0; x < 355; x += 5) ASSERT_LT(covered.at(x, y), 15) << x << " " << y;
    for (int x = 365; x < 720; x += 5) ASSERT_EQ(covered.at(x, y), usual.at(x, y)) << x << " " << y;
  }
}

TEST(ImageFault, AFaceIsABrightBlobBehindTheHand) {
  const auto [usual, faced] = usual_and_faulty({.face = true});
  int blob = 0;
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 720; ++x) {
      if (usual.at(x, y) > 60) {
        EXPECT_NEAR(faced.at(x, y), usual.at(x, y), 1) << "the hand is in front";
      }
      blob += usual.at(x, y) < 20 && faced.at(x, y) > 60;
    }
  EXPECT_GT(blob, 15'000);
  EXPECT_LT(blob, 60'000);
}

}  // namespace
}  // namespace handcast::twin
