// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "services/tools/preview/rig_feed.hpp"

namespace handcast::preview {

/// A rig that may go down and come up again while it is watched. One thread.
class RigFollower {
 public:
  /// Follows the rig that `feed` reads.
  explicit RigFollower(RigFeed feed)
      : rig_(feed.rig()), projector_(feed.projector()), feed_(std::move(feed)) {}

  /// As RigFeed::look(). If the rig is down, looks for it now and then instead.
  void look();
  /// As RigFeed::scene(); dark while the rig is down.
  Scene scene();
  /// As RigFeed::gauges(); without figures while the rig is down.
  Gauges gauges() const;

 private:
  static constexpr std::int64_t kRetry_ns = 500'000'000;

  std::string rig_;
  config::Viewpoint projector_;
  std::optional<RigFeed> feed_;  ///< empty: the rig is down
  std::string why_down_;         ///< a sentence for the person
  std::int64_t next_try_ns_ = 0;
};

}  // namespace handcast::preview
