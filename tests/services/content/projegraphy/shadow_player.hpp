// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <numbers>
#include <optional>

#include "services/content/hands.hpp"
#include "services/content/projegraphy/recogniser.hpp"
#include "services/content/unwrap.hpp"
#include "services/lab/twin/articulation.hpp"
#include "services/lab/twin/person.hpp"
#include "services/lab/twin/random.hpp"
#include "tests/renderer/hand_pose.hpp"
#include "tests/services/content/made_hand.hpp"

namespace handcast::projegraphy {

/// With the hands of the build.
inline const Recogniser& recogniser() {
  static const Recogniser made(
      {&content::made_hand(content::Side::left), &content::made_hand(content::Side::right)});
  return made;
}

/// How inexactly people hold an animal: standard deviations.
struct Sloppiness {
  double flexion_deg = 6, splay_deg = 3, turn_deg = 7, spin_deg = 12, apart_m = 0.006;
};

/// A person of the twin who holds animals in front of the rig's projector, as a perfect tracker
/// reports it.
class ShadowPlayer {
 public:
  /// `seed` 0: the mean person.
  explicit ShadowPlayer(int seed, config::TwinShape spread = {}) : seed_(seed) {
    if (seed == 0) spread.length_spread = spread.width_spread = 0;
    shape_ = twin::draw_person(spread, seed);
  }

  /// Holds an animal with hands of the build; `swaps` does what one hand does with the other one.
  /// `take`: the number of the try, each with other faults.
  void hold(const Animal& animal, int take, const Sloppiness& faults = {}, bool swaps = false) {
    const twin::Random random(1000 * seed_ + take, twin::Stream::tracker_noise);
    std::uint64_t next = 0;
    const auto draw = [&](double sigma) {
      return static_cast<float>(sigma * random.normal(next++));
    };
    const float spin = draw(faults.spin_deg);
    std::array<std::optional<HeldHand>, 2> held;
    for (std::size_t i = 0; i < animal.hands.size(); ++i) {
      HeldHand hand = animal.hands[i];
      for (auto& finger : hand.flexion) {
        const float all = draw(faults.flexion_deg);
        for (float& angle : finger) angle += all + draw(0.5 * faults.flexion_deg);
      }
      for (float& angle : hand.splay) angle += draw(faults.splay_deg);
      hand.thumb_flexion += draw(faults.flexion_deg);
      hand.thumb_opposition += draw(faults.flexion_deg);
      hand.turn += draw(faults.turn_deg);
      hand.nod += draw(faults.turn_deg);
      hand.wrist_m += glm::vec2(draw(faults.apart_m), draw(faults.apart_m));
      const float c = std::cos(glm::radians(spin)), s = std::sin(glm::radians(spin));
      hand.wrist_m = {c * hand.wrist_m.x - s * hand.wrist_m.y,
                      s * hand.wrist_m.x + c * hand.wrist_m.y};
      hand.spin += spin;
      if (swaps) hand.spin = -hand.spin, hand.wrist_m.x = -hand.wrist_m.x;
      held[swaps ? 1 - i : i] = hand;
    }
    show(held);
  }
  /// Moves the hands in camera space, m.
  void move(const glm::vec3& by_m) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (auto& at : positions_m_[i]) at += by_m;
      for (auto& at : hands_[i].joints_m) at += by_m;
    }
  }

  /// Left and right.
  const content::BothHands& hands() const { return hands_; }
  Silhouette silhouette() const {
    const auto projector = content::viewer_of(calibration_);
    std::vector<FlatHand> flat;
    for (const auto& hand : hands_) {
      if (!hand.is_there) continue;
      flat.push_back({hand.mesh, {}});
      for (const auto& at : hand.positions_m) flat.back().px.push_back(projector.pixel_of(at));
    }
    return silhouette_of(flat);
  }
  const calib::Calibration& calibration() const { return calibration_; }

 private:
  void show(const std::array<std::optional<HeldHand>, 2>& held) {
    const twin::Articulation articulation(shape_);
    const glm::mat4 tracker_from_camera = glm::inverse(glm::mat4(calibration_.camera_from_tracker));
    glm::mat4 place(1);
    place[3] = glm::vec4(-middle_of(held), 0.7f, 1);
    content::Hands tracked(
        {content::made_hand(content::Side::left), content::made_hand(content::Side::right)}, rig_,
        calibration_);
    tracked.needs_surface(true);
    msg::HandPoses poses;
    for (std::size_t i = 0; i < 2; ++i) {
      if (!held[i]) continue;
      const auto side = i == 0 ? content::Side::left : content::Side::right;
      const glm::mat4 wrist =
          tracker_from_camera * place * joints_of(content::made_hand(side), *held[i])[1];
      poses.hands[poses.count++] =
          renderer::pose_of(side, articulation.frames(side, glm::dmat4(wrist), bend_of(*held[i])));
    }
    constexpr std::int64_t kStart_ns = 1'000'000'000, kStep_ns = 10'000'000;
    for (int k = 0; k < 40; ++k) {
      poses.header.origin_ns = poses.header.published_ns = kStart_ns + k * kStep_ns;
      tracked.push(poses);
    }
    hands_ = tracked.at(kStart_ns + 39 * kStep_ns);
    for (std::size_t i = 0; i < 2; ++i) {
      positions_m_[i].assign(hands_[i].positions_m.begin(), hands_[i].positions_m.end());
      normals_[i].assign(hands_[i].normals.begin(), hands_[i].normals.end());
      hands_[i].positions_m = positions_m_[i];
      hands_[i].normals = normals_[i];
      hands_[i].mesh = &content::made_hand(i == 0 ? content::Side::left : content::Side::right);
    }
  }
  /// The middle of the joints of all hands.
  static glm::vec2 middle_of(const std::array<std::optional<HeldHand>, 2>& held) {
    glm::vec2 low(1), high(-1);
    for (std::size_t i = 0; i < 2; ++i) {
      if (!held[i]) continue;
      const auto side = i == 0 ? content::Side::left : content::Side::right;
      for (const auto& joint : joints_of(content::made_hand(side), *held[i])) {
        low = glm::min(low, glm::vec2(joint[3]));
        high = glm::max(high, glm::vec2(joint[3]));
      }
    }
    return 0.5f * (low + high);
  }
  static twin::Bend bend_of(const HeldHand& held) {
    constexpr double kRadian = std::numbers::pi / 180;
    twin::Bend bend;
    for (std::size_t f = 0; f < 5; ++f) {
      for (std::size_t k = 0; k < 3; ++k) bend.flexion[f][k] = kRadian * held.flexion[f][k];
      bend.splay[f] = kRadian * held.splay[f];
    }
    bend.thumb_flexion = kRadian * held.thumb_flexion;
    bend.thumb_opposition = kRadian * held.thumb_opposition;
    return bend;
  }

  int seed_;
  renderer::HandShape shape_;
  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::array<std::vector<glm::vec3>, 2> positions_m_, normals_;
  content::BothHands hands_;
};

}  // namespace handcast::projegraphy
