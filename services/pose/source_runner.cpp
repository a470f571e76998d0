// SPDX-License-Identifier: Apache-2.0
#include "services/pose/source_runner.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "ipc/base/log.hpp"

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMostWaiting = 64;
constexpr auto kTurn = 50ms;          ///< how long one call of a source may wait
constexpr auto kOpenAgainEvery = 1s;  ///< a lost source

}  // namespace

void PairInbox::put(const PairSample& sample) {
  {
    const std::scoped_lock lock(mutex_);
    samples_.push_back(sample);
    if (samples_.size() > kMostWaiting) samples_.pop_front();
  }
  came_.notify_one();
}

std::optional<PairSample> PairInbox::take(Deadline deadline) {
  const std::chrono::steady_clock::time_point until(std::chrono::nanoseconds(deadline.time_ns()));
  std::unique_lock lock(mutex_);
  came_.wait_until(lock, until, [this] { return !samples_.empty(); });
  if (samples_.empty()) return std::nullopt;
  const auto sample = samples_.front();
  samples_.pop_front();
  return sample;
}

SourceRunner::SourceRunner(From from, Open open, std::unique_ptr<WatchedSource> source,
                           PairInbox& inbox)
    : from_(from),
      open_(std::move(open)),
      source_(std::move(source)),
      inbox_(inbox),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void SourceRunner::see(const msg::Landmarks& landmarks, int view) {
  {
    const std::scoped_lock lock(mutex_);
    seen_.at(static_cast<std::size_t>(view)) = landmarks;
  }
  changed_.notify_all();
}

std::string SourceRunner::trouble() const {
  const std::scoped_lock lock(mutex_);
  return trouble_;
}

void SourceRunner::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (!source_)
      reopen(stop);
    else if (show_landmarks(stop))
      sample_once();
  }
}

void SourceRunner::reopen(const std::stop_token& stop) {
  auto opened = open_();
  if (opened) {
    source_ = std::move(*opened);
    return;
  }
  say(opened.error().what);
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop, kOpenAgainEvery, [] { return false; });
}

/// True if the source can be sampled now.
bool SourceRunner::show_landmarks(const std::stop_token& stop) {
  if (source_->views() == 0) return true;
  const auto has_come = [this] {
    return std::ranges::any_of(seen_, [](const auto& seen) { return seen.has_value(); });
  };
  std::unique_lock lock(mutex_);
  if (source_->needs_landmarks()) changed_.wait_for(lock, stop, kTurn, has_come);
  const bool is_new = has_come();
  const auto seen = std::exchange(seen_, {});
  lock.unlock();
  for (int view = 0; view < source_->views(); ++view)
    if (const auto& landmarks = seen[static_cast<std::size_t>(view)])
      source_->see(*landmarks, view);
  return is_new || !source_->needs_landmarks();
}

void SourceRunner::sample_once() {
  PairSample sample{.from = from_};
  const auto sampled = source_->sample(sample.poses, Deadline::in(kTurn));
  if (!sampled) {
    say(sampled.error().what);
    const bool is_lost =
        sampled.error().code != Errc::timeout && sampled.error().code != Errc::bad_data;
    if (is_lost) {
      log::warning("{}; it is opened again", sampled.error().what);
      source_.reset();
    }
    return;
  }
  sample.arrival_ns = now_ns();
  sample.is_usable = source_->is_usable();
  sample.depends_on_calibration = source_->depends_on_calibration();
  sample.faults = source_->take_faults();
  say({});
  inbox_.put(sample);
}

void SourceRunner::say(std::string trouble) {
  const std::scoped_lock lock(mutex_);
  trouble_ = std::move(trouble);
}

}  // namespace handcast::pose
