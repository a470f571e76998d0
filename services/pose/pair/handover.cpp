// SPDX-License-Identifier: Apache-2.0
#include "services/pose/pair/handover.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "renderer/base/joint_math.hpp"

namespace handcast::pose {
namespace {

using renderer::orientation;
using renderer::position;

/// Of the two quaternions of a rotation, the one nearer to no rotation.
glm::quat shorter(const glm::quat& q) { return q.w < 0 ? -q : q; }

glm::quat mixed(const glm::quat& a, const glm::quat& b, float share) {
  return shorter(glm::normalize(a * (1 - share) + b * share));
}

const glm::quat kNone{1, 0, 0, 0};

}  // namespace

JointOffsets JointOffsets::between(const msg::HandPose& from, const msg::HandPose& to) {
  JointOffsets offsets;
  for (int j = 0; j < msg::kJoints; ++j) {
    offsets.moved_m_[j] = position(to.joints[j]) - position(from.joints[j]);
    offsets.turned_[j] =
        shorter(orientation(to.joints[j]) * glm::conjugate(orientation(from.joints[j])));
  }
  return offsets;
}

msg::HandPose JointOffsets::applied(const msg::HandPose& pose, float share) const {
  msg::HandPose moved = pose;
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::vec3 at = position(pose.joints[j]) + share * moved_m_[j];
    const glm::quat turned =
        glm::normalize(mixed(kNone, turned_[j], share) * orientation(pose.joints[j]));
    moved.joints[j].position_m = {at.x, at.y, at.z};
    moved.joints[j].orientation_xyzw = {turned.x, turned.y, turned.z, turned.w};
  }
  return moved;
}

void JointOffsets::approach(const JointOffsets& other, float share) {
  for (int j = 0; j < msg::kJoints; ++j) {
    moved_m_[j] = glm::mix(moved_m_[j], other.moved_m_[j], share);
    turned_[j] = mixed(turned_[j], other.turned_[j], share);
  }
}

JointOffsets JointOffsets::reversed() const {
  JointOffsets offsets;
  for (int j = 0; j < msg::kJoints; ++j) {
    offsets.moved_m_[j] = -moved_m_[j];
    offsets.turned_[j] = glm::conjugate(turned_[j]);
  }
  return offsets;
}

float JointOffsets::farthest_m(const JointOffsets& other) const {
  float farthest_m = 0;
  for (int j = 0; j < msg::kJoints; ++j)
    farthest_m = std::max(farthest_m, glm::distance(moved_m_[j], other.moved_m_[j]));
  return farthest_m;
}

float JointOffsets::mean_m(const JointOffsets& other) const {
  float sum_m = 0;
  for (int j = 0; j < msg::kJoints; ++j) sum_m += glm::distance(moved_m_[j], other.moved_m_[j]);
  return sum_m / msg::kJoints;
}

namespace {

constexpr std::int64_t kSpan_ns = 250'000'000, kBeside_ns = 20'000'000;
/// Samples farther apart are not interpolated.
constexpr std::int64_t kGap_ns = 60'000'000;

}  // namespace

void RecentPoses::add(std::int64_t origin_ns, const msg::HandPose& pose) {
  if (!poses_.empty() && origin_ns <= newest_ns()) return;
  poses_.push_back({origin_ns, pose});
  while (poses_.front().origin_ns < origin_ns - kSpan_ns) poses_.pop_front();
}

std::optional<msg::HandPose> RecentPoses::at(std::int64_t time_ns) const {
  const auto after = std::ranges::lower_bound(poses_, time_ns, {}, &Timed::origin_ns);
  if (after == poses_.end()) {
    const bool is_near = !poses_.empty() && time_ns - newest_ns() <= kBeside_ns;
    return is_near ? std::optional(poses_.back().pose) : std::nullopt;
  }
  if (after == poses_.begin()) {
    const bool is_near = after->origin_ns - time_ns <= kBeside_ns;
    return is_near ? std::optional(after->pose) : std::nullopt;
  }
  const auto before = std::prev(after);
  const std::int64_t step_ns = after->origin_ns - before->origin_ns;
  if (step_ns > kGap_ns) return std::nullopt;
  const double share =
      static_cast<double>(time_ns - before->origin_ns) / static_cast<double>(step_ns);
  return JointOffsets::between(after->pose, before->pose)
      .applied(after->pose, static_cast<float>(1 - share));
}

namespace {

constexpr float kLearning = 0.02f;  ///< share of a new difference in the mean
/// A difference so much larger than the mean one shows that the old source had gone astray.
constexpr float kAstray_m = 0.03f;
/// A hand that was published longer ago is not continued.
constexpr std::int64_t kForgotten_ns = 200'000'000;

constexpr std::array kSides{msg::Side::left, msg::Side::right};

std::size_t index(msg::Side side) { return static_cast<std::size_t>(side); }

From other(From from) { return from == From::first ? From::second : From::first; }

/// 1 at the begin, 0 at the end, without a jump of the velocity.
float remaining(double t) {
  const auto u = static_cast<float>(std::clamp(t, 0.0, 1.0));
  return 1 - u * u * (3 - 2 * u);
}

}  // namespace

std::optional<msg::HandPoses> Handover::push(From from, const msg::HandPoses& sample,
                                             std::int64_t arrival_ns, bool is_usable) {
  if (!begun_ns_) begun_ns_ = arrival_ns;
  note(from, sample, arrival_ns, is_usable);
  for (const auto side : kSides) learn(side);
  choose(arrival_ns);
  const bool is_newer = !has_published_ || sample.header.origin_ns > last_ns_;
  const bool stands_in = sample.count == 0 && is_silent(in_use_, arrival_ns);
  if ((from != in_use_ && !stands_in) || !is_newer) return std::nullopt;
  auto published = blended(sample, is_usable);
  if (has_published_) published.header.frame_id = std::max(sample.header.frame_id, last_id_ + 1);
  last_id_ = published.header.frame_id;
  last_ns_ = published.header.origin_ns;
  has_published_ = true;
  return published;
}

void Handover::note(From from, const msg::HandPoses& sample, std::int64_t arrival_ns,
                    bool is_usable) {
  Source& source = of(from);
  source.heard_ns = arrival_ns;
  if (!is_good(from, arrival_ns)) source.since_ns.reset();
  if (!is_usable) {
    source.since_ns.reset();
    return;
  }
  source.good_ns = arrival_ns;
  if (!source.since_ns) source.since_ns = arrival_ns;
  for (const auto side : kSides)
    if (const auto* hand = sample.find(side))
      source.hands[index(side)].add(sample.header.origin_ns, *hand);
}

bool Handover::is_good(From from, std::int64_t now_ns) const {
  const auto& good_ns = sources_[static_cast<std::size_t>(from)].good_ns;
  return good_ns && now_ns - *good_ns <= ms_to_ns(settings_.patience_ms);
}

bool Handover::is_silent(From from, std::int64_t now_ns) const {
  const auto& heard_ns = sources_[static_cast<std::size_t>(from)].heard_ns;
  return now_ns - heard_ns.value_or(*begun_ns_) > ms_to_ns(settings_.patience_ms);
}

void Handover::learn(msg::Side side) {
  const auto& first = of(From::first).hands[index(side)];
  const auto& second = of(From::second).hands[index(side)];
  const std::int64_t time_ns = std::min(first.newest_ns(), second.newest_ns());
  if (time_ns <= hands_[index(side)].learned_ns) return;
  hands_[index(side)].learned_ns = time_ns;
  const auto here = first.at(time_ns), there = second.at(time_ns);
  if (!here || !there) return;
  const auto offsets = JointOffsets::between(*there, *here);
  auto& mean = hands_[index(side)].second_to_first;
  if (mean)
    mean->approach(offsets, kLearning);
  else
    mean = offsets;
}

void Handover::choose(std::int64_t now_ns) {
  const bool is_new = now_ns - *begun_ns_ < ms_to_ns(settings_.patience_ms);
  if (!is_good(in_use_, now_ns) && is_good(other(in_use_), now_ns) && !is_new)
    return take(other(in_use_));
  const auto& first = of(From::first);
  if (in_use_ == From::second && is_good(From::first, now_ns) && first.since_ns &&
      now_ns - *first.since_ns >= ms_to_ns(settings_.return_ms))
    take(From::first);
}

void Handover::take(From from) {
  for (const auto side : kSides) hands_[index(side)].blend = blend_to(from, side);
  in_use_ = from;
}

std::optional<Handover::Blend> Handover::blend_to(From from, msg::Side side) const {
  const Hand& hand = hands_[index(side)];
  const auto& poses = sources_[static_cast<std::size_t>(from)].hands[index(side)];
  const std::int64_t last_ns = hand.published.newest_ns();
  if (last_ns == 0 || poses.newest_ns() - last_ns > kForgotten_ns) return std::nullopt;
  std::optional<JointOffsets> mean = hand.second_to_first;
  if (mean && from == From::first) mean = mean->reversed();
  const auto was = hand.published.at(last_ns), there = poses.at(last_ns);
  if (was && there) {
    const auto offsets = JointOffsets::between(*there, *was);
    const bool is_astray = mean && offsets.mean_m(*mean) > kAstray_m && !hand.blend;
    return Blend{is_astray ? *mean : offsets, last_ns};
  }
  return mean ? std::optional(Blend{*mean, last_ns}) : std::nullopt;
}

msg::HandPoses Handover::blended(const msg::HandPoses& sample, bool is_usable) {
  msg::HandPoses published = sample;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(sample.count, msg::kMaxHands); ++i) {
    Hand& hand = hands_[index(sample.hands[i].side)];
    if (hand.blend) {
      const std::int64_t since_ns = sample.header.origin_ns - hand.blend->begins_ns;
      const double span_ns = settings_.blend_ms * 1e6;
      if (static_cast<double>(since_ns) < span_ns)
        published.hands[i] = hand.blend->offsets.applied(
            sample.hands[i], remaining(static_cast<double>(since_ns) / span_ns));
      else
        hand.blend.reset();
    }
    if (is_usable) hand.published.add(sample.header.origin_ns, published.hands[i]);
  }
  return published;
}

}  // namespace handcast::pose
