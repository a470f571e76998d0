// SPDX-License-Identifier: Apache-2.0
// After the first frames nothing is allocated, locked or touched for the first time, whatever the
// hands do: each of these makes a frame late now and then.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "config/settings/choice.hpp"
#include "ipc/base/prefault.hpp"
#include "tests/frame_costs.hpp"
#include "tests/renderer/pipeline/driven_pipeline.hpp"
#include "tests/renderer/poses.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kFrame_ns = 1'000'000'000 / 946, kExposure_ns = 1'000'000'000 / 525;

/// How a hand is held.
struct Held {
  glm::vec3 moved_m{0};
  float closed = 0;  ///< 0: open; 1: a fist
};

samples::Pose closed_by(float share) {
  samples::Pose pose{"closing", samples::kFist.thumb, samples::kFist.fingers};
  for (float& degrees : pose.thumb) degrees *= share;
  for (auto& finger : pose.fingers)
    for (float& degrees : finger) degrees *= share;
  return pose;
}

/// The parts of a scene, one after the other. Each begins and ends as `rest` is.
enum class Part { rest, grows, crosses, closes, leaves, count };
constexpr std::int64_t kPart_ns = 250 * kMs;

/// Hands 0.73 m from the camera; each part brings them nearer than 0.45 m, through the borders of
/// the screen, to a fist, or out of the image.
Held held_at(std::int64_t time_ns) {
  const auto part = static_cast<Part>(time_ns / kPart_ns % static_cast<int>(Part::count));
  const float there =
      0.5f - 0.5f * std::cos(static_cast<float>(time_ns % kPart_ns) / kPart_ns * 6.2832f);
  Held held{{0, -0.18f, 0}};
  if (part == Part::grows) held.moved_m.y += 0.3f * there;
  if (part == Part::crosses) held.moved_m += glm::vec3(0.25f, 0.1f, 0.15f) * there;
  if (part == Part::closes) held.closed = there;
  if (part == Part::leaves) held.moved_m.x += 0.7f * there;
  return held;
}

/// A scene of one or two hands, frame by frame, whose costs are counted by stage. The second hand
/// comes after the first part.
class Scene {
 public:
  Scene(const config::Cascade& settings, int hands, bool is_shared)
      : rig_(rig_above_hand()), hands_(hands) {
    if (is_shared) rig_.projector2 = calib::SecondProjector{"", rig_.projector};
    pipeline_ = make_pipeline(settings, rig_, {});
    prefault_memory();
  }

  /// Runs until `until_ns`.
  void run(std::int64_t until_ns) {
    for (; now_ns_ < until_ns; now_ns_ += kFrame_ns) step();
  }
  /// Forgets the costs so far.
  void forget() { costs_.clear(); }
  const std::map<std::string, test::FrameCosts>& costs() const { return costs_; }
  int most_hands() const { return most_hands_; }

 private:
  std::vector<msg::HandPose> poses_at(std::int64_t time_ns) const {
    const Held held = held_at(time_ns);
    std::vector<msg::HandPose> poses;
    for (int h = 0; h < (time_ns < kPart_ns ? 1 : hands_); ++h) {
      const HandMesh& mesh = default_hand(h == 0 ? Side::left : Side::right);
      const float aside_m = hands_ == 1 ? 0 : h == 0 ? -0.085f : 0.085f;
      poses.push_back(renderer::pose_of(mesh.side, posed(mesh, closed_by(held.closed)),
                                        held.moved_m + glm::vec3(aside_m, 0, 0)));
    }
    return poses;
  }
  msg::Landmarks detected(std::int64_t time_ns) const {
    msg::Landmarks all;
    for (const auto& pose : poses_at(time_ns)) {
      const auto one = landmarks_of(rig_, time_ns, pose, {3, 4});
      all.header = one.header;
      all.hands[all.count] = one.hands[0];
      for (auto& point : all.hands[all.count++].points) point.sigma_px = 3;
    }
    return all;
  }
  Image<std::uint8_t> image_at(std::int64_t time_ns) const {
    const auto poses = poses_at(time_ns);
    return poses.size() == 1 ? image_of(rig_, {poses[0]}) : image_of(rig_, {poses[0], poses[1]});
  }

  /// One frame, with the messages that arrive before it: a tracker's, 9 ms old, every 9 ms, and a
  /// detector's, 16 ms old, every 16 ms.
  void step() {
    if (now_ns_ >= exposed_ns_ + kExposure_ns + 3 * kMs) {
      exposed_ns_ = (now_ns_ - 3 * kMs) / kExposure_ns * kExposure_ns;
      image_ = image_at(exposed_ns_);
      ++image_id_;
    }
    for (; sample_ns_ + 9 * kMs <= now_ns_; sample_ns_ += 9 * kMs) {
      const auto reported = poses_of(sample_ns_, poses_at(sample_ns_));
      count("push", [&] { pipeline_->push(now_ns_, reported); });
    }
    for (; detection_ns_ + 16 * kMs <= now_ns_; detection_ns_ += 16 * kMs) {
      const auto seen = detected(detection_ns_);
      count("push", [&] { pipeline_->push(now_ns_, seen); });
    }
    render();
  }
  template <class Call>
  void count(const std::string& name, const Call& call) {
    const auto before = test::frame_costs();
    call();
    costs_[name] += test::frame_costs() - before;
  }

  /// Each stage ends with a look at the clock.
  void render() {
    looks_.reserve(64);
    looks_.clear();
    test::at_each_look_at_the_clock = [] { looks_.push_back(test::frame_costs()); };
    const TimedImage image{image_.view(), exposed_ns_, image_id_};
    const Frame frame = pipeline_->render(now_ns_, now_ns_ + 4 * kMs, image);
    test::at_each_look_at_the_clock = nullptr;
    const auto after = test::frame_costs();
    most_hands_ = std::max(most_hands_, static_cast<int>(frame.hands.size()));
    ASSERT_EQ(looks_.size(), frame.stages.size() + 1)
        << "a stage looks at the clock elsewhere, too";
    looks_.back() = after;  // the last look ends the frame
    for (std::size_t i = 0; i < frame.stages.size(); ++i)
      costs_[std::string(msg::kStageNames[static_cast<std::size_t>(frame.stages[i].stage)])] +=
          looks_[i + 1] - looks_[i];
  }

  static thread_local std::vector<test::FrameCosts> looks_;

  calib::Calibration rig_;
  int hands_, most_hands_ = 0;
  std::unique_ptr<Pipeline> pipeline_;
  std::int64_t now_ns_ = 0, exposed_ns_ = 0, sample_ns_ = 0, detection_ns_ = 0;
  std::uint64_t image_id_ = 0;
  Image<std::uint8_t> image_ = image_at(0);
  std::map<std::string, test::FrameCosts> costs_;
};

thread_local std::vector<test::FrameCosts> Scene::looks_;

void expect_nothing(const Scene& scene) {
  for (const auto& [stage, costs] : scene.costs()) {
    EXPECT_EQ(costs.allocations, 0u) << stage;
    EXPECT_EQ(costs.locks, 0u) << stage;
    EXPECT_EQ(costs.faults, 0u) << stage;
  }
}

class SteadyFrames : public ::testing::TestWithParam<config::CorrectMethod> {
 protected:
  void SetUp() override {
    if (!test::are_costs_counted()) GTEST_SKIP() << "sanitizers allocate memory of their own";
  }
  /// Counts in all parts but the first, in which the hands rest. The system may take a page back,
  /// but hardly in three scenes in succession; a first touch comes in each.
  static void expect_steady(int hands, bool is_shared = false) {
    for (int left = 3; left > 0; --left) {
      Scene scene(cascade(GetParam(), config::FillMethod::reflect), hands, is_shared);
      scene.run(kPart_ns);
      scene.forget();
      scene.run(static_cast<int>(Part::count) * kPart_ns);
      const bool has_faults = std::ranges::any_of(
          scene.costs(), [](const auto& stage) { return stage.second.faults != 0; });
      if (has_faults && left > 1) continue;
      EXPECT_EQ(scene.most_hands(), hands);
      expect_nothing(scene);
      return;
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Methods, SteadyFrames,
                         ::testing::Values(config::CorrectMethod::vertices,
                                           config::CorrectMethod::grid),
                         [](const auto& each) { return std::string(config::word_of(each.param)); });

TEST_P(SteadyFrames, OneHandThatGrowsCrossesTheScreenClosesAndLeavesCostsNothingNew) {
  expect_steady(1);
}

TEST_P(SteadyFrames, NeitherDoTwoHandsOfWhichOneComesLater) { expect_steady(2); }

TEST_P(SteadyFrames, NorDoTwoHandsWhoseLightIsSharedWithAnotherProjector) {
  expect_steady(2, true);
}

}  // namespace
}  // namespace handcast::renderer
