// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/shot.hpp"

#include "ipc/base/clock.hpp"
#include "ipc/base/write_whole.hpp"
#include "renderer/media/picture.hpp"
#include "services/tools/preview/rig_feed.hpp"

namespace handcast::preview {

Result<void> shoot(const Options& options) {
  if (auto possible = check_writable(options.shot); !possible) return possible;
  auto feed = RigFeed::open(options.rig);
  if (!feed) return tl::make_unexpected(std::move(feed.error()));
  const auto end_ns = now_ns() + seconds_to_ns(options.after_s);
  for (auto next_ns = now_ns(); next_ns < end_ns; next_ns += RigFeed::kPeriod_ns) {
    sleep_until_ns(next_ns);
    if (auto well = feed->look(); !well) return well;
  }
  const auto picture = draw(feed->scene(), feed->gauges(), options.look);
  return renderer::write_png(options.shot, picture.view());
}

}  // namespace handcast::preview
