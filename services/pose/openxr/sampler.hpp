// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::pose::openxr {

/// What a runtime says of one hand at the time that it was asked for.
struct Answer {
  bool is_active = false;                         ///< it tracks this hand
  bool is_whole = false;                          ///< it knows place and orientation of every joint
  int tracked = 0;                                ///< joints that it sees and does not infer
  std::array<msg::Joint, msg::kJoints> joints{};  ///< in the axes of the space
};

/// Both hands, indexed by msg::Side.
using Answers = std::array<Answer, 2>;

/// Makes samples of the answers of a runtime, which does not say when it measured anything. One
/// thread.
class Sampler {
 public:
  /// Fills the hands of `poses`, without its header. Returns false if no hand has changed in any
  /// bit since the last answers: the runtime has measured nothing new. Answers without a hand are
  /// always new. The first answers are not: nobody knows how long they have been there. A hand of
  /// which a joint is not known is left out. Errors: bad_data (a hand is no hand, and there is no
  /// other).
  Result<bool> take(const Answers& answers, msg::HandPoses& poses);

  /// Whether the runtime gave the same joints for two times: it does not regard the time.
  static bool are_equal(const Answers& answers, const Answers& others);

 private:
  Answers last_{};
  bool has_last_ = false;
};

}  // namespace handcast::pose::openxr
