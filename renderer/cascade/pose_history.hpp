#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "config/sections/cascade.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// The recent poses of one hand, asked for at a time: interpolated inside the history, predicted beyond it up to a stated limit.
/// Positions are interpolated linearly, orientations by normalised quaternion blending. Samples may come late or out of order.
class PoseHistory {
 public:
  explicit PoseHistory(const config::Predict& settings, std::int64_t span_ns = 250'000'000);

  void push(std::int64_t origin_ns, const msg::HandPose& pose);
  void clear();

  bool empty() const { return samples_.empty(); }
  std::int64_t newest_ns() const;  ///< 0 where empty

  /// The hand at `time_ns`; nothing where the history is empty, or ends more than `lost_ns` before `time_ns`.
  /// Before the oldest sample: the oldest. Beyond the newest: by config::Predict::method, joint by joint.
  std::optional<msg::HandPose> at(std::int64_t time_ns, std::int64_t lost_ns = 200'000'000) const;

 private:
  struct Sample {
    std::int64_t origin_ns;
    msg::HandPose pose;
  };
  config::Predict settings_;
  std::int64_t span_ns_;
  std::deque<Sample> samples_;
};

}  // namespace handcast::renderer
