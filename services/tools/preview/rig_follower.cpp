// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/rig_follower.hpp"

#include <utility>

#include "ipc/base/clock.hpp"

namespace handcast::preview {

void RigFollower::look() {
  if (feed_) {
    if (feed_->look()) return;
    // Also if it has been started anew since: its rings are others then.
    feed_.reset();
    next_try_ns_ = now_ns();
    why_down_ = "the rig is down; `handcast up` starts it, and this picture goes on";
  }
  if (now_ns() < next_try_ns_) return;
  next_try_ns_ = now_ns() + kRetry_ns;
  auto feed = RigFeed::open(rig_, projector_);
  if (feed)
    feed_.emplace(std::move(*feed));
  else if (feed.error().code != Errc::unavailable)
    why_down_ = feed.error().what;  // of another version
}

Scene RigFollower::scene() {
  if (feed_) return feed_->scene();
  Scene scene;
  scene.is_down = true;
  scene.missing.push_back(why_down_);
  return scene;
}

Gauges RigFollower::gauges() const { return feed_ ? feed_->gauges() : Gauges{.rig = rig_}; }

}  // namespace handcast::preview
