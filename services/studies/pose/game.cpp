// SPDX-License-Identifier: Apache-2.0
#include "services/studies/pose/game.hpp"

#include <algorithm>
#include <cmath>

#include "services/lab/twin/random.hpp"

namespace handcast::study {

PoseGame::PoseGame(std::vector<HeldPose> poses, std::uint64_t seed) : poses_(std::move(poses)) {
  for (std::size_t left = poses_.size(); left > 1; --left)
    std::swap(poses_[left - 1], poses_[twin::mixed(seed ^ twin::mixed(left)) % left]);
}

const HeldPose* PoseGame::wanted() const {
  return matched_.size() < poses_.size() ? &poses_[matched_.size()] : nullptr;
}

void PoseGame::step(double step_s, const HeldPose* held) {
  step_s = std::clamp(step_s, 0.0, 0.1);
  score_.reset();
  const auto* pose = wanted();
  if (!pose || !held) {
    held_s_ = 0;
    return;
  }
  score_ = score_of(*pose, *held);
  shown_s_ += step_s;
  held_s_ = score_->worst_finger >= kDone ? held_s_ + step_s : 0;
  if (held_s_ < kHeld_s) return;
  matched_.push_back({pose->name, shown_s_});
  shown_s_ = held_s_ = 0;
}

void RangeOfMotion::see(const HeldPose& held) {
  const auto flexions = flexions_deg(held);
  for (std::size_t joint = 0; joint < flexions.size(); ++joint)
    ++seen_[joint][static_cast<std::size_t>(std::clamp(std::lround(flexions[joint]), 0l, 180l))];
  ++count_;
}

std::optional<std::array<RangeOfMotion::Range, kFlexions>> RangeOfMotion::ranges() const {
  if (count_ == 0) return {};
  std::array<Range, kFlexions> ranges;
  const std::uint32_t outside = count_ / 50;
  for (std::size_t joint = 0; joint < kFlexions; ++joint) {
    const auto& seen = seen_[joint];
    const auto first = [&](bool from_above) {
      std::uint32_t sum = 0;
      for (int k = 0; k <= 180; ++k) {
        const int degree = from_above ? 180 - k : k;
        if ((sum += seen[static_cast<std::size_t>(degree)]) > outside)
          return static_cast<float>(degree);
      }
      return 0.f;
    };
    ranges[joint] = {first(false), first(true)};
  }
  return ranges;
}

}  // namespace handcast::study
