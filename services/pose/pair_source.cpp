// SPDX-License-Identifier: Apache-2.0
#include "services/pose/pair_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "ipc/base/log.hpp"

namespace handcast::pose {
namespace {

/// Without a sample of either source for so long, both are silent; without a hand, nobody is there.
constexpr std::int64_t kSilent_ns = 2'000'000'000;
constexpr std::int64_t kLookEvery_ns = 50'000'000;  ///< at two sources of which neither is open yet

using Opened = std::optional<Result<SourceFacts>>;

bool is_open(const Opened& opened) { return opened && opened->has_value(); }
bool is_wrong(const Opened& opened) {
  return opened && !*opened && opened->error().code == Errc::bad_config;
}
/// The views of a source; of one that is not open yet, both.
int views_of(const Opened& opened) { return is_open(opened) ? (*opened)->views : kMostViews; }

void say_missing(const Opened& opened, const std::string& name) {
  if (is_open(opened)) return;
  log::warning("{}; the other source is used meanwhile",
               opened ? opened->error().what : name + ": it does not open");
}

/// Two sources, each with a thread of its own.
class PairSource final : public PoseSource {
 public:
  PairSource(const config::Handover& settings, PairParts parts)
      : parts_(std::move(parts)), handover_(settings) {}

  /// Opens the sources one after the other, because loaders change the environment.
  Result<void> begin() {
    auto first = start(first_, From::first, parts_.first);
    if (is_wrong(first)) return tl::make_unexpected(first->error());
    auto second = start(second_, From::second, parts_.second);
    // If neither is ever open, the supervisor ends this.
    while (!is_open(first) && !is_open(second) && !is_wrong(second) && !(first && second)) {
      first = first_->opened(Deadline::now());
      second = second_->opened(Deadline::at_ns(now_ns() + kLookEvery_ns));
    }
    if (is_wrong(second)) return tl::make_unexpected(second->error());
    if (!is_open(first) && !is_open(second)) return tl::make_unexpected(first->error());
    say_missing(first, parts_.first.name);
    say_missing(second, parts_.second.name);
    views_ = std::max(views_of(first), views_of(second));
    conventions_ = is_open(first) ? (*first)->conventions : (*second)->conventions;
    heard_ns_ = hand_ns_ = now_ns();
    return {};
  }

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    for (;;) {
      const auto sample = inbox_->take(deadline);
      // A sample may have waited for long, if this was not called: what counts is that it is here.
      if (sample) heard_ns_ = now_ns();
      if (sample && sample->poses.count > 0) hand_ns_ = heard_ns_;
      if (auto usable = check_calls(); !usable) return usable;
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
    first_->see(landmarks, view);
    second_->see(landmarks, view);
  }
  bool is_adjustable() const override { return true; }
  void adjust(const config::Rig& rig) override {
    first_->adjust(rig);
    second_->adjust(rig);
  }
  bool depends_on_calibration() const override { return depends_on_calibration_; }
  joints::Conventions conventions() const override { return conventions_; }
  msg::TrackerFaults take_faults() override { return std::exchange(faults_, {}); }

 private:
  Opened start(std::unique_ptr<SourceRunner>& runner, From from, const PairPart& part) {
    runner = std::make_unique<SourceRunner>(from, part, parts_.patience, inbox_);
    return runner->opened(Deadline::at_ns(now_ns() + parts_.start_ns));
  }

  /// Says once which source hangs. Errors: unavailable (see open_pair()).
  Result<void> check_calls() {
    const std::array runners{first_.get(), second_.get()};
    for (std::size_t i = 0; i < runners.size(); ++i) {
      const std::int64_t hung_ns = runners[i]->hung_ns();
      const bool hangs = hung_ns > 0;
      if (hangs != std::exchange(hangs_[i], hangs) && hangs)
        log::warning("{}; the other source is used meanwhile", runners[i]->trouble());
      const bool is_silent = now_ns() - heard_ns_ > kSilent_ns;
      const bool nobody_is_there = now_ns() - hand_ns_ > kSilent_ns && hung_ns > parts_.restart_ns;
      if (hangs && (is_silent || nobody_is_there))
        return fail(Errc::unavailable, runners[i]->trouble() + "; the service is started anew");
    }
    return {};
  }

  std::string why_silent() const {
    const auto first = first_->trouble(), second = second_->trouble();
    if (first.empty() || second.empty()) return "pose: no sample of either source yet";
    return fmt::format("{}; {}", first, second);
  }
  void say_handover() {
    const bool is_second = handover_.in_use() == From::second;
    const auto trouble = is_second ? first_->trouble() : std::string();
    log::warning("pose: the {} source is used now{}{}", is_second ? "second" : "first",
                 trouble.empty() ? "" : ": ", trouble);
  }

  PairParts parts_;
  int views_ = 0;
  joints::Conventions conventions_;
  Handover handover_;
  bool depends_on_calibration_ = false;
  msg::TrackerFaults faults_;
  std::array<bool, 2> hangs_{};
  std::int64_t heard_ns_ = 0;  ///< when the last sample of either was taken
  std::int64_t hand_ns_ = 0;   ///< when the last with a hand was taken
  std::shared_ptr<PairInbox> inbox_ = std::make_shared<PairInbox>();
  std::unique_ptr<SourceRunner> first_, second_;
};

}  // namespace

Result<std::unique_ptr<PoseSource>> open_pair(const config::Handover& settings, PairParts parts) {
  auto source = std::make_unique<PairSource>(settings, std::move(parts));
  if (auto begun = source->begin(); !begun) return tl::make_unexpected(begun.error());
  return source;
}

}  // namespace handcast::pose
