// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/stereo_tracker.hpp"

#include <algorithm>
#include <utility>

#include "services/pose/stereo/cover.hpp"

namespace handcast::pose::stereo {
namespace {

/// A hand of which a view cannot see so many landmarks goes on without looks.
constexpr std::size_t kMostHidden = msg::kLandmarks / 4;
/// The sigmas of what a view sees of a hand that is hidden but for a little are larger by so much.
constexpr double kDoubt = 8;
/// From this log of the odds on, hands are taken for the other ones.
constexpr double kSureOfOther = 2.5;

std::vector<ReportedHand> reports_of(const msg::Landmarks* landmarks) {
  std::vector<ReportedHand> reports;
  if (!landmarks) return reports;
  for (std::uint32_t i = 0; i < landmarks->count && i < landmarks->hands.size(); ++i) {
    const auto& hand = landmarks->hands[i];
    if (hand.side != msg::Side::left && hand.side != msg::Side::right) continue;
    if (const auto seen = read(hand))
      reports.push_back({hand.side, std::clamp<double>(hand.presence, 0, 1), *seen});
  }
  return reports;
}

using Places = std::array<std::optional<PosedHand>, msg::kMaxHands>;

Expected projected(const Views& views, const std::optional<PosedHand>& hand) {
  if (!hand) return std::nullopt;
  std::array<Points, kViews> points;
  for (int v = 0; v < kViews; ++v)
    for (int i = 0; i < msg::kLandmarks; ++i)
      points[v][i] = views[v].project(hand->place_m[msg::kJointOfLandmark[i]]);
  return points;
}

/// Takes what the other hand hides out of the looks. True if it hides a large part from a view.
bool hide(const Views& views, const std::optional<PosedHand>& hand,
          const std::optional<PosedHand>& other, Looks& looks) {
  if (!hand || !other) return false;
  bool is_hidden = false;
  for (int v = 0; v < kViews; ++v) {
    const Hidden hidden = hidden_by(*other, *hand, views[v]);
    is_hidden = is_hidden || hidden.count() > kMostHidden;
    if (!looks[v]) continue;
    auto& sigma_px = looks[v]->hand.seen.sigma_px;
    const double doubt = 1 + kDoubt * static_cast<double>(hidden.count()) / msg::kLandmarks;
    for (int i = 0; i < msg::kLandmarks; ++i) sigma_px[i] *= hidden[i] ? 0 : doubt;
    if (std::ranges::count_if(sigma_px, [](double sigma) { return sigma > 0; }) < kFewestSeen)
      looks[v].reset();
  }
  return is_hidden;
}

}  // namespace

Seen seen_of(const Pair& pair) {
  return {pair[0] ? &*pair[0] : nullptr, pair[1] ? &*pair[1] : nullptr};
}

Result<StereoTracker> StereoTracker::open(const config::Rig& rig, const Views& views,
                                          const glm::dmat4& tracker_from_first) {
  const auto left = renderer::load_hand_or_default(rig.hand.left, msg::Side::left);
  if (!left) return fail_in("left hand", left.error());
  const auto right = renderer::load_hand_or_default(rig.hand.right, msg::Side::right);
  if (!right) return fail_in("right hand", right.error());
  const auto hand = [&](const renderer::HandMesh& mesh) {
    return StereoHand(mesh, rig.pose.stereo, views, tracker_from_first);
  };
  return StereoTracker(views, {hand(*left), hand(*right)});
}

std::array<Expected, msg::kMaxHands> StereoTracker::expected(std::int64_t time_ns) const {
  return {projected(views_, hands_[0].expected(time_ns)),
          projected(views_, hands_[1].expected(time_ns))};
}

msg::HandPoses StereoTracker::sample(const Seen& seen) {
  msg::HandPoses poses;
  for (const auto* landmarks : seen)
    if (landmarks)
      poses.header.origin_ns = std::max(poses.header.origin_ns, landmarks->header.origin_ns);
  poses.header.frame_id = samples_++;
  const std::int64_t time_ns = poses.header.origin_ns;
  const Reports reports{reports_of(seen[0]), reports_of(seen[1])};
  const Places places{hands_[0].expected(time_ns), hands_[1].expected(time_ns)};
  const Matches matches = match(hands_[0].skeleton(), views_, reports,
                                {projected(views_, places[0]), projected(views_, places[1])});
  HandLooks looks;
  for (int side = 0; side < msg::kMaxHands; ++side)
    for (int v = 0; v < kViews; ++v)
      if (matches[side][v] >= 0)
        looks[side][v] =
            Look{reports[v][static_cast<std::size_t>(matches[side][v])], seen[v]->header.origin_ns};
  std::array<bool, msg::kMaxHands> hidden{};
  for (int side = 0; side < msg::kMaxHands; ++side)
    hidden[side] = hide(views_, places[side], places[1 - side], looks[side]);
  if (settle_sides(time_ns, looks))
    for (auto& hand : hands_) hand.forget();
  for (int side = 0; side < msg::kMaxHands; ++side) {
    auto pose = hands_[side].follow(time_ns, looks[side]);
    if (!pose && hidden[side]) pose = hands_[side].predict(time_ns);
    if (pose) poses.hands[poses.count++] = *pose;
  }
  return poses;
}

/// Exchanges the looks of hands that are taken for each other, or gives those of one to the other.
/// True if it has. Compares one hand at most, in turn: a comparison takes milliseconds.
bool StereoTracker::settle_sides(std::int64_t time_ns, HandLooks& looks) {
  double log_odds = 0;
  bool has_compared = false;
  for (int i = 0; i < msg::kMaxHands; ++i) {
    const int side = static_cast<int>((samples_ + static_cast<unsigned>(i)) % msg::kMaxHands);
    auto& evidence = evidence_[side];
    if (!hands_[side].expected(time_ns)) evidence.forget();
    int looked = 0, votes = 0;
    for (const auto& look : looks[side])
      if (look) ++looked, votes += static_cast<int>(look->hand.side) == side ? -1 : 1;
    if (looked > 0 && !has_compared && evidence.is_due(time_ns)) {
      const auto cost = hands_[side].cost_anew(looks[side]),
                 cost_of_other = hands_[1 - side].cost_anew(looks[side]);
      has_compared = cost && cost_of_other;
      if (has_compared)
        evidence.compare(time_ns, *cost, *cost_of_other, votes), ++comparisons_;
      else
        evidence.vote(time_ns, votes);
    }
    log_odds += evidence.log_odds();
  }
  if (!(log_odds >= kSureOfOther)) return false;
  std::swap(looks[0], looks[1]);
  for (auto& evidence : evidence_) evidence.forget();
  return true;
}

}  // namespace handcast::pose::stereo
