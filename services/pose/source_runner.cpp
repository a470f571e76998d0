// SPDX-License-Identifier: Apache-2.0
#include "services/pose/source_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <utility>

#include "ipc/base/log.hpp"

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMostWaiting = 64;
constexpr auto kTurn = 50ms;          ///< how long one call of a source may wait
constexpr auto kOpenAgainEvery = 1s;  ///< a lost source

std::chrono::steady_clock::time_point point(std::int64_t time_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns));
}

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
  std::unique_lock lock(mutex_);
  came_.wait_until(lock, point(deadline.time_ns()), [this] { return !samples_.empty(); });
  if (samples_.empty()) return std::nullopt;
  const auto sample = samples_.front();
  samples_.pop_front();
  return sample;
}

/// What the thread of a runner does, and what it shares with others.
class SourceRunner::Work {
 public:
  Work(From from, PairPart part, const Patience& patience, std::shared_ptr<PairInbox> inbox)
      : from_(from), part_(std::move(part)), patience_(patience), inbox_(std::move(inbox)) {}

  /// The thread.
  void run(const std::stop_token& stop);

  /// Any thread.
  /// @{
  std::optional<Result<SourceFacts>> opened(Deadline deadline);
  bool await_end();
  void see(const msg::Landmarks& landmarks, int view);
  void adjust(const config::Rig& rig);
  std::string trouble();
  std::int64_t hung_ns() const;
  /// @}

 private:
  void open(const std::stop_token& stop);
  void adjust_source();
  void sample_once();
  void close();
  bool show_landmarks(const std::stop_token& stop);
  void say(std::string trouble);
  /// From here to leave(), the thread is in a call that should end in this time.
  void enter(std::int64_t patience_ns) { due_ns_ = now_ns() + patience_ns; }
  void leave() { due_ns_ = 0; }

  From from_;
  PairPart part_;
  Patience patience_;
  std::shared_ptr<PairInbox> inbox_;
  std::unique_ptr<WatchedSource> source_;
  std::atomic<std::int64_t> due_ns_{0};  ///< when the call should end that runs; 0: none does
  std::mutex mutex_;
  std::condition_variable_any changed_;                         ///< new landmarks, an end
  std::array<std::optional<msg::Landmarks>, kMostViews> seen_;  ///< by view
  std::string trouble_;
  std::shared_ptr<const config::Rig> rig_;     ///< the newest settings; null: those of its start
  bool is_rig_new_ = false;                    ///< the source does not have them yet
  std::optional<Result<SourceFacts>> opened_;  ///< the first attempt
  bool has_ended_ = false;
};

void SourceRunner::Work::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (!source_)
      open(stop);
    else if (show_landmarks(stop))
      sample_once();
  }
  close();
  const std::scoped_lock lock(mutex_);
  has_ended_ = true;
  changed_.notify_all();
}

void SourceRunner::Work::open(const std::stop_token& stop) {
  enter(patience_.open_ns);
  auto opened = part_.open();
  leave();
  std::unique_lock lock(mutex_);
  trouble_ = opened ? "" : opened.error().what;
  if (opened) source_ = std::move(*opened);
  is_rig_new_ = rig_ != nullptr;
  if (!opened_)
    opened_ = opened ? Result<SourceFacts>({source_->views(), source_->conventions()})
                     : tl::make_unexpected(opened.error());
  changed_.notify_all();
  if (!source_) changed_.wait_for(lock, stop, kOpenAgainEvery, [] { return false; });
}

void SourceRunner::Work::close() {
  enter(patience_.call_ns);
  source_.reset();
  leave();
}

/// True if the source can be sampled now.
bool SourceRunner::Work::show_landmarks(const std::stop_token& stop) {
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

void SourceRunner::Work::adjust_source() {
  std::unique_lock lock(mutex_);
  if (!std::exchange(is_rig_new_, false)) return;
  const auto rig = rig_;
  lock.unlock();
  source_->adjust(*rig);
}

void SourceRunner::Work::sample_once() {
  adjust_source();
  PairSample sample{.from = from_};
  enter(patience_.call_ns);
  const auto sampled = source_->sample(sample.poses, Deadline::in(kTurn));
  leave();
  if (!sampled) {
    say(sampled.error().what);
    const bool is_lost =
        sampled.error().code != Errc::timeout && sampled.error().code != Errc::bad_data;
    if (is_lost) {
      log::warning("{}; it is opened again", sampled.error().what);
      close();
    }
    return;
  }
  sample.arrival_ns = now_ns();
  sample.is_usable = source_->is_usable();
  sample.depends_on_calibration = source_->depends_on_calibration();
  sample.faults = source_->take_faults();
  say({});
  inbox_->put(sample);
}

void SourceRunner::Work::say(std::string trouble) {
  const std::scoped_lock lock(mutex_);
  trouble_ = std::move(trouble);
}

std::optional<Result<SourceFacts>> SourceRunner::Work::opened(Deadline deadline) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, point(deadline.time_ns()), [this] { return opened_.has_value(); });
  return opened_;
}

/// False if the thread is in a call that hangs.
bool SourceRunner::Work::await_end() {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kTurn, [this] { return has_ended_; }))
    if (hung_ns() > 0) return false;
  return true;
}

void SourceRunner::Work::see(const msg::Landmarks& landmarks, int view) {
  const std::scoped_lock lock(mutex_);
  seen_.at(static_cast<std::size_t>(view)) = landmarks;
  changed_.notify_all();
}

void SourceRunner::Work::adjust(const config::Rig& rig) {
  auto copy = std::make_shared<const config::Rig>(rig);
  const std::scoped_lock lock(mutex_);
  rig_ = std::move(copy);
  is_rig_new_ = true;
}

std::string SourceRunner::Work::trouble() {
  if (hung_ns() > 0)
    return fmt::format("{}: its software hangs: a call does not return", part_.name);
  const std::scoped_lock lock(mutex_);
  return trouble_;
}

std::int64_t SourceRunner::Work::hung_ns() const {
  const std::int64_t due_ns = due_ns_;
  return due_ns == 0 ? 0 : std::max<std::int64_t>(now_ns() - due_ns, 0);
}

SourceRunner::SourceRunner(From from, PairPart part, const Patience& patience,
                           std::shared_ptr<PairInbox> inbox)
    : work_(std::make_shared<Work>(from, std::move(part), patience, std::move(inbox))),
      thread_([work = work_](const std::stop_token& stop) { work->run(stop); }) {}

SourceRunner::~SourceRunner() {
  thread_.request_stop();
  if (!work_->await_end()) thread_.detach();
}

std::optional<Result<SourceFacts>> SourceRunner::opened(Deadline deadline) const {
  return work_->opened(deadline);
}
void SourceRunner::see(const msg::Landmarks& landmarks, int view) { work_->see(landmarks, view); }
void SourceRunner::adjust(const config::Rig& rig) { work_->adjust(rig); }
std::string SourceRunner::trouble() const { return work_->trouble(); }
std::int64_t SourceRunner::hung_ns() const { return work_->hung_ns(); }

}  // namespace handcast::pose
