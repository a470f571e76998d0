// SPDX-License-Identifier: Apache-2.0
#include "supervisor/record/recorder.hpp"

#include <fcntl.h>

#include <algorithm>
#include <utility>

namespace handcast::supervisor {
namespace {

/// The most messages of a service per poll(), so that no service can block the event loop.
constexpr int kMostAtOnce = 2048;

}  // namespace

Result<void> Recorder::follow(std::string service, int ring_fd) {
  if (std::ranges::find(sources_, service, &Source::service) != sources_.end()) return {};
  auto segment = ipc::Segment::open(UniqueFd(fcntl(ring_fd, F_DUPFD_CLOEXEC, 3)));
  if (!segment) return tl::make_unexpected(segment.error());
  auto marks = ipc::Reader<msg::StageMarks>::attach(std::move(*segment));
  if (!marks) return tl::make_unexpected(marks.error());
  history_.add_service(service);
  sources_.push_back({std::move(service), std::move(*marks)});
  return {};
}

void Recorder::poll() {
  for (auto& source : sources_) {
    for (int i = 0; i < kMostAtOnce; ++i) {
      const auto marks = source.marks.next(Deadline::now());
      if (!marks) break;
      const auto skipped = source.marks.skipped();
      const auto missed = skipped - std::exchange(source.skipped, skipped);
      ledger_.add(source.service, **marks, missed);
      history_.add(source.service, **marks, missed);
      source.last_sign_ns = (*marks)->header.published_ns;
    }
  }
}

std::optional<double> Recorder::silence_ms(std::string_view service, std::int64_t now_ns) const {
  for (const auto& source : sources_)
    if (source.service == service && source.last_sign_ns > 0)
      return ns_to_ms(now_ns - source.last_sign_ns);
  return std::nullopt;
}

}  // namespace handcast::supervisor
