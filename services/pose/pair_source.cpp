// SPDX-License-Identifier: Apache-2.0
#include "services/pose/pair_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ipc/base/log.hpp"

namespace handcast::pose {
namespace {

/// The views of a source; of one that is not open yet, both.
int views_of(const std::unique_ptr<WatchedSource>& source) {
  return source ? source->views() : kMostViews;
}

/// Two sources, each with a thread of its own.
class PairSource final : public PoseSource {
 public:
  PairSource(const config::Handover& settings, PairParts parts,
             std::unique_ptr<WatchedSource> first, std::unique_ptr<WatchedSource> second)
      : views_(std::max(views_of(first), views_of(second))),
        conventions_(first ? first->conventions() : second->conventions()),
        handover_(settings),
        first_(From::first, std::move(parts.first), std::move(first), inbox_),
        second_(From::second, std::move(parts.second), std::move(second), inbox_) {}

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    for (;;) {
      const auto sample = inbox_.take(deadline);
      if (!sample) return fail(Errc::timeout, why_silent());
      faults_ += sample->faults;
      const From before = handover_.in_use();
      const auto published =
          handover_.push(sample->from, sample->poses, sample->arrival_ns, sample->is_usable);
      if (handover_.in_use() != before) say_handover();
      if (!published) continue;
      poses = *published;
      depends_on_calibration_ = sample->depends_on_calibration;
      return {};
    }
  }

  int views() const override { return views_; }
  bool needs_landmarks() const override { return false; }
  void see(const msg::Landmarks& landmarks, int view) override {
    first_.see(landmarks, view);
    second_.see(landmarks, view);
  }
  bool depends_on_calibration() const override { return depends_on_calibration_; }
  joints::Conventions conventions() const override { return conventions_; }
  msg::TrackerFaults take_faults() override { return std::exchange(faults_, {}); }

 private:
  std::string why_silent() const {
    const auto first = first_.trouble(), second = second_.trouble();
    if (first.empty() || second.empty()) return "pose: no sample of either source yet";
    return fmt::format("{}; {}", first, second);
  }
  void say_handover() {
    const bool is_second = handover_.in_use() == From::second;
    const auto trouble = is_second ? first_.trouble() : std::string();
    log::warning("pose: the {} source is used now{}{}", is_second ? "second" : "first",
                 trouble.empty() ? "" : ": ", trouble);
  }

  int views_;
  joints::Conventions conventions_;
  Handover handover_;
  bool depends_on_calibration_ = false;
  msg::TrackerFaults faults_;
  PairInbox inbox_;
  SourceRunner first_, second_;
};

}  // namespace

Result<std::unique_ptr<PoseSource>> open_pair(const config::Handover& settings, PairParts parts) {
  auto first = parts.first(), second = parts.second();
  for (auto* opened : {&first, &second}) {
    if (*opened) continue;
    const bool is_final = opened->error().code == Errc::bad_config || (!first && !second);
    if (is_final) return tl::make_unexpected(opened->error());
    log::warning("{}; the other source is used meanwhile", opened->error().what);
  }
  return std::make_unique<PairSource>(settings, std::move(parts),
                                      first ? std::move(*first) : nullptr,
                                      second ? std::move(*second) : nullptr);
}

}  // namespace handcast::pose
