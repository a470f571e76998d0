// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/motion.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "services/lab/twin/finger_pose.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kBuiltin{
    "open_close", "wave",          "rotate",        "pinch",     "shake",           "two_hands",
    "still",      "crossing",      "flip",          "fist",      "point_at_camera", "enter_leave",
    "reverse",    "cross_fingers", "turn_pointing", "turn_fist", "places",          "count",
    "piano",      "grasp",         "beckon",        "coin"};

std::unique_ptr<Motion> motion_of(const config::Twin& settings) {
  auto motion = open_motion(settings, calib::reference_rig());
  if (!motion) ADD_FAILURE() << motion.error().what;
  return motion ? std::move(*motion) : nullptr;
}

std::unique_ptr<Motion> motion_of(const std::string& name) {
  config::Twin settings;
  settings.motion = name;
  return motion_of(settings);
}

glm::dvec2 seen_at_px(const glm::mat4& frame) {
  const auto rig = calib::reference_rig();
  return rig.camera.project(glm::dvec3(rig.camera_from_tracker * glm::dvec4(place(frame), 1)));
}

/// Calls `check(t, before, now, after)` every `step_s`, with the joints at t - 1 ms, t and t + 1
/// ms.
template <class Check>
void walk(const Motion& motion, double seconds, double step_s, Check&& check) {
  for (const Side side : {Side::left, Side::right}) {
    if (!motion.at(side, 0)) continue;
    for (double t = 0; t < seconds; t += step_s) {
      const auto before = motion.at(side, t - 1e-3), now = motion.at(side, t),
                 after = motion.at(side, t + 1e-3);
      if (before && now && after) check(t, *before, *now, *after);
    }
  }
}

std::vector<std::string> all_motions() {
  std::vector<std::string> names;
  for (const auto& name : kBuiltin) names.push_back("builtin:" + name);
  if (std::filesystem::exists(outside_data() / "lmc"))
    for (const char* name : {"translation", "rotation", "deformation", "all_5s"})
      names.push_back(outside_data() / "lmc" / name);
  return names;
}

TEST(Motion, IsTheSameWhateverOrderItIsAskedIn) {
  for (const auto& name : all_motions()) {
    const auto one = motion_of(name), other = motion_of(name);
    std::vector<JointFrames> forward;
    for (int i = 0; i < 20; ++i)
      forward.push_back(one->at(Side::left, 0.37 * i).value_or(JointFrames{}));
    for (int i = 19; i >= 0; --i)
      EXPECT_EQ(forward[i], other->at(Side::left, 0.37 * i).value_or(JointFrames{})) << name;
  }
}

TEST(Motion, IsSmooth) {
  for (const auto& name : all_motions()) {
    const auto motion = motion_of(name);
    double worst_m_s2 = 0, worst_rad_s = 0;
    walk(*motion, 12, 0.011,
         [&](double, const JointFrames& before, const JointFrames& now, const JointFrames& after) {
           for (int j = 0; j < msg::kJoints; ++j) {
             worst_m_s2 = std::max(
                 worst_m_s2,
                 glm::length(place(before[j]) - 2.0 * place(now[j]) + place(after[j])) * 1e6);
             for (int axis = 0; axis < 3; ++axis)
               worst_rad_s = std::max(
                   worst_rad_s, double(glm::distance(before[j][axis], after[j][axis])) / 2e-3);
           }
         });
    EXPECT_LT(worst_m_s2, 250) << name << ": a jump shows as an acceleration";
    EXPECT_LT(worst_rad_s, 150) << name << ": a jump of an axis";
  }
}

TEST(Motion, JointsAreRigidFrames) {
  for (const auto& name : all_motions())
    walk(*motion_of(name), 8, 0.13,
         [&](double, const JointFrames&, const JointFrames& now, const JointFrames&) {
           for (const auto& frame : now) {
             const glm::mat3 axes(frame);
             const glm::mat3 off = glm::transpose(axes) * axes - glm::mat3(1);
             for (int c = 0; c < 3; ++c) ASSERT_LT(glm::length(off[c]), 1e-4f) << name;
             ASSERT_GT(glm::determinant(axes), 0) << name;
           }
         });
}

TEST(BuiltinMotion, IsWhollyInView) {
  constexpr double kFlesh_px = 16;  // from a joint to the hand's outline
  for (const auto& name : kBuiltin)
    for (const int seed : {1, 2, 3, 4}) {
      if (name == "enter_leave") continue;
      config::Twin settings;
      settings.motion = "builtin:" + name;
      settings.seed = seed;
      walk(*motion_of(settings), 16, 0.05,
           [&](double t, const JointFrames&, const JointFrames& now, const JointFrames&) {
             for (int j = 0; j < msg::kJoints; ++j) {
               const glm::dvec2 px = seen_at_px(now[j]);
               ASSERT_TRUE(px.x > kFlesh_px && px.y > kFlesh_px && px.x < 719 - kFlesh_px &&
                           px.y < 539 - kFlesh_px)
                   << name << " " << renderer::kJointNames[j] << " at " << t << " s: " << px.x
                   << " " << px.y;
             }
           });
    }
}

TEST(BuiltinMotion, BonesKeepTheirLengths) {
  for (const auto& name : kBuiltin) {
    const auto motion = motion_of("builtin:" + name);
    const auto& shape = motion->shape();
    walk(*motion, 6, 0.21,
         [&](double, const JointFrames&, const JointFrames& now, const JointFrames&) {
           for (int f = 1; f < 5; ++f)
             for (int k = 0; k < 3; ++k) {
               const int joint = 5 * f + 2 + k;
               ASSERT_NEAR(1e3 * glm::distance(place(now[joint]), place(now[joint + 1])),
                           shape.phalanx_mm[f][k], 0.01)
                   << name;
             }
         });
  }
}

double peak_speed_m_s(const Motion& motion, int joint) {
  double peak = 0;
  walk(motion, 8, 0.004,
       [&](double, const JointFrames& before, const JointFrames&, const JointFrames& after) {
         peak = std::max(peak, glm::distance(place(after[joint]), place(before[joint])) / 2e-3);
       });
  return peak;
}

TEST(BuiltinMotion, ShakeIsFasterThanAMetreASecondAndStillIsStill) {
  const double shake = peak_speed_m_s(*motion_of("builtin:shake"), 0);
  EXPECT_GT(shake, 1.1);
  EXPECT_LT(shake, 1.6);
  EXPECT_LT(peak_speed_m_s(*motion_of("builtin:still"), 0), 0.012);
  for (const auto& name : kBuiltin) {
    const auto motion = motion_of("builtin:" + name);
    std::printf("[ speeds   ] %-10s palm %.2f m/s, middle tip %.2f m/s\n", name.c_str(),
                peak_speed_m_s(*motion, 0), peak_speed_m_s(*motion, 15));
  }
}

TEST(BuiltinMotion, RotateShowsThePalm) {
  const auto motion = motion_of("builtin:rotate");
  const glm::dmat3 camera_from_tracker(calib::reference_rig().camera_from_tracker);
  const auto back_z = [&](double t) {
    return (camera_from_tracker * glm::dvec3((*motion->at(Side::left, t))[1][1])).z;
  };
  EXPECT_LT(back_z(0), -0.8);
  EXPECT_GT(back_z(4), 0.8);
}

TEST(BuiltinMotion, PinchBringsThumbAndIndexTogether) {
  double nearest_mm = 1e9, farthest_mm = 0;
  walk(*motion_of("builtin:pinch"), 4, 0.01,
       [&](double, const JointFrames&, const JointFrames& now, const JointFrames&) {
         const double gap_mm = 1e3 * glm::distance(place(now[5]), place(now[10]));
         nearest_mm = std::min(nearest_mm, gap_mm);
         farthest_mm = std::max(farthest_mm, gap_mm);
       });
  EXPECT_LT(nearest_mm, 20);
  EXPECT_GT(nearest_mm, 6) << "the finger tips must not penetrate each other";
  EXPECT_GT(farthest_mm, 60);
}

TEST(BuiltinMotion, TwoHandsMirrorEachOtherOutOfStep) {
  const auto motion = motion_of("builtin:two_hands");
  double nearest_px = 1e9;
  for (double t = 0; t < 10; t += 0.05) {
    const auto left = *motion->at(Side::left, t), right = *motion->at(Side::right, t);
    double left_most = 0, right_least = 1e9;
    for (int j = 0; j < msg::kJoints; ++j) {
      left_most = std::max(left_most, seen_at_px(left[j]).x);
      right_least = std::min(right_least, seen_at_px(right[j]).x);
    }
    nearest_px = std::min(nearest_px, right_least - left_most);
  }
  EXPECT_GT(nearest_px, 30) << "side by side, not crossing";
  const auto right = *motion->at(Side::right, 0);
  EXPECT_GT(seen_at_px(right[21]).x, seen_at_px(right[6]).x)
      << "the right hand's little finger is on the right, seen from its back";
  EXPECT_FALSE(motion_of("builtin:wave")->at(Side::right, 0));
}

double mean_x_px(const JointFrames& hand) {
  double sum = 0;
  for (const auto& joint : hand) sum += seen_at_px(joint).x;
  return sum / static_cast<double>(hand.size());
}

TEST(BuiltinMotion, CrossingHandsSwapPlacesAndPassBeforeOneAnother) {
  const auto motion = motion_of("builtin:crossing");
  const glm::dmat4 camera_from_tracker(calib::reference_rig().camera_from_tracker);
  const auto depth_m = [&](Side side, double t) {
    return (camera_from_tracker * glm::dvec4(place((*motion->at(side, t))[11]), 1)).z;
  };
  EXPECT_LT(mean_x_px(*motion->at(Side::left, 0)), mean_x_px(*motion->at(Side::right, 0)) - 250);
  EXPECT_GT(mean_x_px(*motion->at(Side::left, 1.25)),
            mean_x_px(*motion->at(Side::right, 1.25)) + 250);
  EXPECT_GT(depth_m(Side::right, 0.625) - depth_m(Side::left, 0.625), 0.08)
      << "thicker than two hands";
}

TEST(BuiltinMotion, FlipShowsThePalmWithinHalfASecond) {
  const auto motion = motion_of("builtin:flip");
  const glm::dmat3 camera_from_tracker(calib::reference_rig().camera_from_tracker);
  const auto back_z = [&](double t) {
    return (camera_from_tracker * glm::dvec3((*motion->at(Side::left, t))[1][1])).z;
  };
  EXPECT_LT(back_z(0.5), -0.8);
  EXPECT_GT(back_z(0.9), 0.8);
  EXPECT_LT(back_z(1.8), -0.8);
}

double reach_m(const JointFrames& hand, int tip) {
  return glm::distance(place(hand[tip]), place(hand[1]));
}

TEST(BuiltinMotion, FistBringsEveryFingerTipToThePalm) {
  const auto motion = motion_of("builtin:fist");
  for (const int tip : {10, 15, 20, 25}) {
    EXPECT_GT(reach_m(*motion->at(Side::left, 0), tip), 0.13);
    EXPECT_LT(reach_m(*motion->at(Side::left, 1), tip), 0.09);
  }
}

TEST(BuiltinMotion, FingersPointIntoTheCamera) {
  const auto motion = motion_of("builtin:point_at_camera");
  const auto seen_px = [&](double t, int knuckle, int tip) {
    const auto hand = *motion->at(Side::left, t);
    return glm::distance(seen_at_px(hand[tip]), seen_at_px(hand[knuckle]));
  };
  for (const auto& [knuckle, tip] : {std::pair(7, 10), std::pair(12, 15), std::pair(17, 20)}) {
    EXPECT_GT(seen_px(0, knuckle, tip), 100);
    EXPECT_LT(seen_px(1.2, knuckle, tip), 40) << "foreshortened";
  }
}

TEST(BuiltinMotion, CrossedFingersSwapPlacesWithoutTouching) {
  const auto motion = motion_of("builtin:cross_fingers");
  const auto apart = *motion->at(Side::left, 0), crossed = *motion->at(Side::left, 1.2);
  EXPECT_GT(seen_at_px(apart[10]).x, seen_at_px(apart[15]).x + 20)
      << "tips of index and middle finger";
  EXPECT_LT(seen_at_px(crossed[10]).x, seen_at_px(crossed[15]).x - 10);
  double nearest_mm = 1e9;
  for (double t = 0; t < 2.4; t += 0.02) {
    const auto hand = *motion->at(Side::left, t);
    for (float a = 0; a <= 1; a += 0.05f)
      for (float b = 0; b <= 1; b += 0.05f)
        nearest_mm = std::min(nearest_mm,
                              1e3 * glm::distance(glm::mix(place(hand[8]), place(hand[10]), a),
                                                  glm::mix(place(hand[13]), place(hand[15]), b)));
  }
  std::printf("[ fingers  ] axes come as near as %.1f mm\n", nearest_mm);
  EXPECT_GT(nearest_mm, 11);
}

TEST(BuiltinMotion, AHandThatLeavesIsOutOfTheImageBeforeItIsGone) {
  const auto motion = motion_of("builtin:enter_leave");
  EXPECT_TRUE(motion->at(Side::left, 0));
  EXPECT_FALSE(motion->at(Side::left, 1.8));
  EXPECT_TRUE(motion->at(Side::left, 2.8));
  for (const double t : {1.499, 2.101}) {
    const auto hand = *motion->at(Side::left, t);
    for (const auto& joint : hand) EXPECT_GT(seen_at_px(joint).y, 541);
  }
}

TEST(BuiltinMotion, ReverseIsAsFastAsTwoMetresASecond) {
  const double peak = peak_speed_m_s(*motion_of("builtin:reverse"), 0);
  EXPECT_GT(peak, 1.8);
  EXPECT_LT(peak, 2.1);
}

TEST(BuiltinMotion, CountingRaisesOneFingerAfterTheOther) {
  const auto motion = motion_of("builtin:count");
  const auto raised = [&](double t) {
    const auto hand = *motion->at(Side::left, t);
    int count = flexion_of(hand)[0][1] < 0.5 ? 1 : 0;
    for (const int tip : {10, 15, 20, 25}) count += reach_m(hand, tip) > 0.13;
    return count;
  };
  for (int n = 0; n <= 5; ++n) EXPECT_EQ(raised(0.05 + 0.85 * n), n);
}

TEST(BuiltinMotion, ThePianoIsPlayedWithEachFingerInTurn) {
  const auto motion = motion_of("builtin:piano");
  for (int finger = 0; finger < 5; ++finger) {
    // At its note, a finger is bent further than 0.3 s later.
    const auto bend = [&](double t) {
      return flexion_of(*motion->at(Side::left, t))[static_cast<std::size_t>(finger)][0];
    };
    const double note_s = 0.2 * finger;
    EXPECT_GT(bend(1.6 + note_s), bend(1.6 + note_s + 0.3) + 0.1) << finger;
  }
}

TEST(BuiltinMotion, TheGraspClosesAboutSomethingAndOpensWider) {
  const auto motion = motion_of("builtin:grasp");
  const auto gap_m = [&](double t) {
    const auto hand = *motion->at(Side::left, t);
    return glm::distance(place(hand[5]), place(hand[15]));
  };
  EXPECT_GT(gap_m(0.65), 0.11);
  EXPECT_LT(gap_m(1.6), 0.08);
  EXPECT_GT(gap_m(1.6), 0.03) << "there is something in the hand";
}

TEST(BuiltinMotion, BeckoningBendsTheFingersThreeTimes) {
  const auto motion = motion_of("builtin:beckon");
  int bent = 0;
  bool is_bent = false;
  for (double t = 0; t < 3; t += 0.005) {
    const double bend = flexion_of(*motion->at(Side::left, t))[2][1];
    if (!is_bent && bend > 1) ++bent;
    if (bend > 1) is_bent = true;
    if (bend < 0.6) is_bent = false;
  }
  EXPECT_EQ(bent, 3);
}

TEST(BuiltinMotion, TheFingersThatRollACoinFollowEachOther) {
  const auto motion = motion_of("builtin:coin");
  const auto highest_s = [&](std::size_t finger) {
    double at_s = 0, least = 10;
    for (double t = 0; t < 1 / 0.7; t += 0.002) {
      const double bend = flexion_of(*motion->at(Side::left, t))[finger][0];
      if (bend < least) {
        least = bend;
        at_s = t;
      }
    }
    return at_s;
  };
  for (std::size_t finger = 1; finger < 4; ++finger) {
    const double later_s = highest_s(finger + 1) - highest_s(finger);
    EXPECT_NEAR(later_s - std::floor(later_s * 0.7) / 0.7, 0.16 / 0.7, 0.01) << finger;
  }
}

TEST(Motion, SpeedScalesTime) {
  for (const auto& name : all_motions()) {
    config::Twin settings;
    settings.motion = name;
    const auto natural = motion_of(settings);
    settings.speed = 2;
    EXPECT_EQ(*motion_of(settings)->at(Side::left, 1.25), *natural->at(Side::left, 2.5)) << name;
  }
}

TEST(Motion, ThePersonIsDrawnFromTheSeed) {
  config::Twin settings;
  settings.motion = "builtin:still";
  const auto mean = renderer::HandShape::mean();
  std::vector<float> lengths;
  for (settings.seed = 0; settings.seed < 40; ++settings.seed) {
    const auto motion = motion_of(settings);
    const float factor = motion->shape().phalanx_mm[2][0] / mean.phalanx_mm[2][0];
    EXPECT_EQ(motion_of(settings)->shape().phalanx_mm, motion->shape().phalanx_mm);
    EXPECT_NEAR(factor, 1, 0.0401);
    EXPECT_NEAR(motion->shape().radius_mm[2][0] / mean.radius_mm[2][0], 1, 0.0601);
    lengths.push_back(factor);
  }
  EXPECT_GT(*std::max_element(lengths.begin(), lengths.end()), 1.025);
  EXPECT_LT(*std::min_element(lengths.begin(), lengths.end()), 0.975);
}

TEST(Motion, AnUnknownNameListsTheKnownOnes) {
  config::Twin settings;
  settings.motion = "builtin:juggle";
  const auto unknown = open_motion(settings, calib::reference_rig());
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Errc::bad_config);
  EXPECT_THAT(unknown.error().what,
              testing::AllOf(HasSubstr("juggle"), HasSubstr("open_close"), HasSubstr("still")));
  settings.motion = "/nowhere/at/all";
  EXPECT_THAT(open_motion(settings, calib::reference_rig()).error().what,
              HasSubstr("/nowhere/at/all"));
  settings.motion = testing::TempDir();
  EXPECT_THAT(open_motion(settings, calib::reference_rig()).error().what,
              HasSubstr("timestamps.npy"));
}

/// The phalanges of a hand: each joint with another one behind it, from the knuckles on.
template <class Visit>
void for_each_phalanx(const Visit& visit) {
  for (int finger = 0; finger < kFingers; ++finger)
    for (int i = 0; i < bends_of(finger); ++i) visit(bend_joint(finger, i));
}

TEST(RecordedMotion, HasTheDirectionsOfEverySampleOnceUnderWay) {
  HANDCAST_NEEDS_RECORDINGS();
  const auto folder = outside_data() / "lmc" / "rotation";
  const auto recording = recording::read_recording(folder);
  const auto motion = motion_of(folder.string());
  constexpr double kLag_s = 0.375 * 0.15;  // the start from rest
  for (std::size_t i = 50; i < 500; i += 25) {
    const auto expected = renderer::frames_of(recording->hands[0][i]);
    const auto found =
        *motion->at(Side::left, static_cast<double>(recording->time_ns[i]) * 1e-9 + kLag_s);
    EXPECT_LT(glm::distance(place(expected[1]), place(found[1])), 2e-6);
    for_each_phalanx([&](int j) {
      const auto way = [j](const auto& frames) {
        return glm::normalize(place(frames[j + 1]) - place(frames[j]));
      };
      EXPECT_LT(glm::distance(way(expected), way(found)), 1e-3) << renderer::kJointNames[j];
      EXPECT_LT(glm::distance(way(found), -glm::normalize(glm::dvec3(found[j][2]))), 1e-3);
    });
  }
}

TEST(RecordedMotion, HasBonesOfConstantLength) {
  HANDCAST_NEEDS_RECORDINGS();
  const auto motion = motion_of((outside_data() / "lmc" / "deformation").string());
  const auto length = [](const auto& frames, int from, int to) {
    return glm::distance(place(frames[from]), place(frames[to]));
  };
  const auto first = *motion->at(Side::left, 0.5);
  for (double t = 0.6; t < 4; t += 0.1) {
    const auto now = *motion->at(Side::left, t);
    for_each_phalanx(
        [&](int j) { EXPECT_NEAR(length(now, j, j + 1), length(first, j, j + 1), 1e-5); });
    for (const int knuckle : {7, 12, 17, 22})
      EXPECT_NEAR(length(now, 1, knuckle), length(first, 1, knuckle), 1e-5);
  }
}

TEST(RecordedMotion, GoesThereAndBackForEver) {
  HANDCAST_NEEDS_RECORDINGS();
  const auto motion = motion_of((outside_data() / "lmc" / "all_5s").string());
  const double duration_s = 4.989229, period_s = 2 * (duration_s + 0.75 * 0.15);
  for (const double t : {0.02, 1.0, 2.6, 4.9, 5.05}) {
    const auto there = *motion->at(Side::left, t);
    EXPECT_LT(glm::distance(place(there[15]), place((*motion->at(Side::left, period_s - t))[15])),
              1e-5);
    EXPECT_LT(glm::distance(place(there[15]), place((*motion->at(Side::left, period_s + t))[15])),
              1e-5);
  }
}

TEST(RecordedMotion, ThePersonHasTheRecordedBones) {
  HANDCAST_NEEDS_RECORDINGS();
  const auto motion = motion_of((outside_data() / "lmc" / "all_5s").string());
  const auto& shape = motion->shape();
  const auto mean = renderer::HandShape::mean();
  for (int f = 0; f < 5; ++f) {
    EXPECT_LT(glm::distance(shape.proximal_mm[f], mean.proximal_mm[f]), 30) << "finger " << f;
    std::printf(
        "[ person   ] finger %d MCP %.0f %.0f %.0f (mean %.0f %.0f %.0f) phalanges %.1f %.1f %.1f "
        "(mean %.1f %.1f %.1f)\n",
        f, shape.proximal_mm[f].x, shape.proximal_mm[f].y, shape.proximal_mm[f].z,
        mean.proximal_mm[f].x, mean.proximal_mm[f].y, mean.proximal_mm[f].z, shape.phalanx_mm[f][0],
        shape.phalanx_mm[f][1], shape.phalanx_mm[f][2], mean.phalanx_mm[f][0],
        mean.phalanx_mm[f][1], mean.phalanx_mm[f][2]);
  }
}

}  // namespace
}  // namespace handcast::twin
