// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "config/sections/handover.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::pose {

/// By how much two sources differ about one hand: a displacement and a rotation of each joint, in
/// tracker space. A value.
class JointOffsets {
 public:
  /// What must be applied to `from` to get `to`.
  static JointOffsets between(const msg::HandPose& from, const msg::HandPose& to);

  /// `pose` with `share` (0..1) of the offsets.
  msg::HandPose applied(const msg::HandPose& pose, float share) const;
  /// Moves by `share` (0..1) towards other offsets.
  void approach(const JointOffsets& other, float share);
  /// The offsets the other way round.
  JointOffsets reversed() const;
  /// The largest and the mean distance to the displacements of other offsets.
  /// @{
  float farthest_m(const JointOffsets& other) const;
  float mean_m(const JointOffsets& other) const;
  /// @}

 private:
  std::array<glm::vec3, msg::kJoints> moved_m_{};
  std::array<glm::quat, msg::kJoints> turned_{};  ///< w >= 0
};

/// The poses of one hand over the last quarter of a second. One thread.
class RecentPoses {
 public:
  /// Adds a pose; ignored if it is not newer than the newest one.
  void add(std::int64_t origin_ns, const msg::HandPose& pose);
  /// The pose at `time_ns`: interpolated; the nearest one up to 20 ms beside the samples. Empty if
  /// there is none.
  std::optional<msg::HandPose> at(std::int64_t time_ns) const;
  /// Time of the newest pose, 0 if there is none.
  std::int64_t newest_ns() const { return poses_.empty() ? 0 : poses_.back().origin_ns; }
  /// Forgets all poses.
  void clear() { poses_.clear(); }

 private:
  struct Timed {
    std::int64_t origin_ns;
    msg::HandPose pose;
  };
  std::deque<Timed> poses_;  ///< oldest first
};

/// The two sources of a pair.
enum class From { first = 0, second = 1 };

/// Makes one stream of samples from those of two sources in the same tracker space. The first one
/// is preferred. The other one takes over when the one in use has had no usable hand for a while,
/// and their difference at the last sample is blended out. If the source in use has gone astray at
/// its end, the mean difference while both saw the hand is taken instead. Depends on its arguments
/// alone. One thread.
class Handover {
 public:
  explicit Handover(const config::Handover& settings) : settings_(settings) {}

  /// Adds a sample that arrived at `arrival_ns`. `is_usable`: it has a hand that was measured.
  /// Returns what is to be published: empty if the other source is in use, or something newer was
  /// published. If the source in use is silent, what the other one says is published even if it has
  /// no hand, so that readers see that a tracker works. Times and numbers of what is returned
  /// increase.
  std::optional<msg::HandPoses> push(From from, const msg::HandPoses& sample,
                                     std::int64_t arrival_ns, bool is_usable);

  /// The source in use.
  From in_use() const { return in_use_; }

 private:
  struct Source {
    std::array<RecentPoses, 2> hands;      ///< by side
    std::optional<std::int64_t> heard_ns;  ///< arrival of the newest sample
    std::optional<std::int64_t> good_ns;   ///< arrival of the newest usable sample
    std::optional<std::int64_t> since_ns;  ///< how long they have been usable without a break
  };
  struct Blend {
    JointOffsets offsets;
    std::int64_t begins_ns = 0;
  };
  /// One hand of the stream.
  struct Hand {
    RecentPoses published;                        ///< those that were usable
    std::optional<JointOffsets> second_to_first;  ///< mean while both saw the hand
    std::int64_t learned_ns = 0;                  ///< up to which time
    std::optional<Blend> blend;
  };

  Source& of(From from) { return sources_[static_cast<std::size_t>(from)]; }
  bool is_good(From from, std::int64_t now_ns) const;
  bool is_silent(From from, std::int64_t now_ns) const;
  void note(From from, const msg::HandPoses& sample, std::int64_t arrival_ns, bool is_usable);
  void learn(msg::Side side);
  void choose(std::int64_t now_ns);
  void take(From from);
  std::optional<Blend> blend_to(From from, msg::Side side) const;
  msg::HandPoses blended(const msg::HandPoses& sample, bool is_usable);

  config::Handover settings_;
  std::array<Source, 2> sources_;
  std::array<Hand, 2> hands_;  ///< by side
  From in_use_ = From::first;
  std::optional<std::int64_t> begun_ns_;  ///< the first arrival of all
  std::int64_t last_ns_ = 0;              ///< origin of what was published last
  std::uint64_t last_id_ = 0;
  bool has_published_ = false;
};

}  // namespace handcast::pose
