// SPDX-License-Identifier: Apache-2.0
#include "services/pose/watched_source.hpp"

#include "ipc/base/log.hpp"

namespace handcast::pose {

WatchedSource::WatchedSource(const std::string& name, std::unique_ptr<PoseSource> source)
    : source_(std::move(source)), complaints_(name) {
  log::info("{}: {}", name, joints::sentence_of(source_->conventions()));
}

Result<void> WatchedSource::sample(msg::HandPoses& poses, Deadline deadline) {
  if (auto sampled = source_->sample(poses, deadline); !sampled) return sampled;
  const std::int64_t arrival_ns = now_ns();
  auto begun = source_->take_faults();
  begun += watch_.look(poses, arrival_ns);
  for (const auto& sentence : complaints_.add(arrival_ns, begun)) log::warning("{}", sentence);
  faults_ += begun;
  return {};
}

}  // namespace handcast::pose
