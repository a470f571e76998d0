// SPDX-License-Identifier: Apache-2.0
#include "services/desk/cues/cues.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "services/desk/controls/complaints.hpp"
#include "services/desk/controls/file_watch.hpp"
#include "services/desk/cues/fades.hpp"
#include "services/desk/cues/place_file.hpp"

namespace handcast::desk {
namespace cues {
namespace {

constexpr std::size_t kMostCommands = 64;  ///< between two turns
constexpr double kRetry_s = 0.5;
constexpr double kDay_s = 86400;
constexpr double kLongestStep_s = 60;  ///< a longer step of the clock starts no times of day

double time_of_day(double wall_s) {
  const auto seconds = static_cast<time_t>(wall_s);
  tm local{};
  ::localtime_r(&seconds, &local);
  return local.tm_hour * 3600 + local.tm_min * 60 + local.tm_sec + (wall_s - std::floor(wall_s));
}

/// How long no hand has been there.
double idle_s(const Scene& scene) {
  double shortest = 1e9;
  for (const auto& hand : scene.gestures)
    shortest = std::min(shortest, hand.is_there ? 0 : hand.absent_s);
  return shortest;
}

struct Command {
  enum class Kind { go, back, hold, jump, key };
  Kind kind = Kind::go;
  int cue = 0;      ///< jump
  std::string key;  ///< key
};

class Deck final : public RunningCues {
 public:
  Deck(CueList list, std::string file, std::filesystem::path state_file, Panel& panel,
       WallClock clock)
      : list_(std::make_shared<const CueList>(std::move(list))),
        file_(std::move(file)),
        watch_(file_),
        state_file_(std::move(state_file)),
        panel_(panel),
        clock_(std::move(clock)),
        wall_s_(clock_()) {
    resume();
    publish();
  }

  void go() override { ask({Command::Kind::go, 0, ""}); }
  void back() override { ask({Command::Kind::back, 0, ""}); }
  void hold() override { ask({Command::Kind::hold, 0, ""}); }
  void key(std::string_view key) override { ask({Command::Kind::key, 0, std::string(key)}); }
  Result<void> jump(std::string_view cue) override;
  std::shared_ptr<const CuePlace> place() const override {
    const std::lock_guard lock(mutex_);
    return place_;
  }

  void turn(const Scene& scene) override;

 private:
  void ask(Command command) {
    const std::lock_guard lock(mutex_);
    if (commands_.size() < kMostCommands) commands_.push_back(std::move(command));
  }
  void obey(const Command& command);
  void look_for_triggers(const Scene& scene, double wall_before_s, double idle_before_s);
  template <class Fires>
  void start_triggered(Fires fires, bool may_be_current);
  void start(int at);
  void fade();
  void keep();
  void resume();
  void read_again();
  bool go_to(std::string_view cue, bool is_faded);
  void publish();
  int after(int cue) const {
    const int count = static_cast<int>(list_->cues.size());
    return list_->loops ? (cue + 1) % count : std::min(cue + 1, count);
  }
  Result<void> change(const std::vector<std::string>& assignments) {
    if (assignments.empty()) return {};
    auto set = panel_.set(assignments, source_);
    if (!set) complaints_.add(now_ns_, set.error().what);
    return set;
  }

  const Cue& cue(int at) const { return list_->cues[static_cast<std::size_t>(at)]; }
  int count() const { return static_cast<int>(list_->cues.size()); }
  std::shared_ptr<const CueList> list() const {
    const std::lock_guard lock(mutex_);
    return list_;
  }

  std::shared_ptr<const CueList> list_;  ///< replaced by the main thread alone, under mutex_
  const std::string file_;
  FileWatch watch_;
  const std::filesystem::path state_file_;
  Panel& panel_;
  WallClock clock_;
  Complaints complaints_{"cues"};
  Fades fades_;
  int current_ = -1, next_ = 0;
  bool is_held_ = false, has_new_names_ = false;
  double elapsed_s_ = 0;  ///< since the current cue was started, without the time that it was held
  double retry_s_ = 0;    ///< as elapsed_s_: a rig that does not answer is not asked before
  double wall_s_;         ///< of this turn
  double started_s_ = 0;  ///< wall clock, when the current cue was started
  double idle_s_ = 0;     ///< in the turn before
  std::int64_t now_ns_ = 0;
  std::string source_;

  mutable std::mutex mutex_;  ///< of what follows
  std::vector<Command> commands_;
  std::shared_ptr<const CuePlace> place_;
};

Result<void> Deck::jump(std::string_view cue) {
  const auto list = this->list();
  const auto found = std::ranges::find(list->cues, cue, &Cue::name);
  auto at = static_cast<int>(found - list->cues.begin());
  if (found == list->cues.end()) {
    int number = 0;
    const auto [end, error] = std::from_chars(cue.data(), cue.data() + cue.size(), number);
    if (error != std::errc() || end != cue.data() + cue.size() || number < 1 ||
        number > static_cast<int>(list->cues.size())) {
      std::vector<std::string_view> names;
      for (const auto& known : list->cues) names.push_back(known.name);
      return fail(Errc::bad_config, fmt::format("there is no cue {}{}; there are {}", quote(cue),
                                                suggest(cue, names), list->cues.size()));
    }
    at = number - 1;
  }
  ask({Command::Kind::jump, at, ""});
  return {};
}

void Deck::turn(const Scene& scene) {
  const double step_s = now_ns_ == 0 ? 0 : ns_to_seconds(scene.now_ns - now_ns_);
  const double wall_before_s = std::exchange(wall_s_, clock_());
  const double idle_before_s = std::exchange(idle_s_, idle_s(scene));
  now_ns_ = scene.now_ns;
  if (watch_.has_changed(now_ns_)) read_again();
  if (!is_held_) elapsed_s_ += step_s;
  std::vector<Command> commands;
  {
    const std::lock_guard lock(mutex_);
    commands.swap(commands_);
  }
  for (const auto& command : commands) obey(command);
  if (!is_held_) {
    look_for_triggers(scene, wall_before_s, idle_before_s);
    fade();
  }
  publish();
}

void Deck::obey(const Command& command) {
  switch (command.kind) {
    case Command::Kind::hold:
      is_held_ = !is_held_;
      return;
    case Command::Kind::go:
      if (std::exchange(is_held_, false)) return;
      if (next_ < count()) start(next_);
      return;
    case Command::Kind::back:
      if (current_ > 0) start(current_ - 1);
      return;
    case Command::Kind::jump:
      if (command.cue < count()) start(command.cue);  // the list may be another one by now
      return;
    case Command::Kind::key:
      start_triggered(
          [&](const Trigger& trigger) {
            return trigger.kind == Trigger::Kind::key && trigger.name == command.key;
          },
          true);
      return;
  }
}

/// Starts the next cue, from the current one on and around the end of the list, with a trigger that
/// fires.
template <class Fires>
void Deck::start_triggered(Fires fires, bool may_be_current) {
  for (int i = 1; i <= count(); ++i) {
    const int at = (current_ + i) % count();
    if (at == current_ && !may_be_current) continue;
    if (std::ranges::any_of(cue(at).triggers, fires)) return start(at);
  }
}

void Deck::look_for_triggers(const Scene& scene, double wall_before_s, double idle_before_s) {
  using Kind = Trigger::Kind;
  for (const auto& event : scene.events)
    start_triggered(
        [&](const Trigger& trigger) {
          return trigger.kind == Kind::event && trigger.name == event;
        },
        false);
  start_triggered(
      [&](const Trigger& trigger) {
        return trigger.kind == Kind::idle && idle_before_s < trigger.seconds &&
               idle_s_ >= trigger.seconds;
      },
      false);
  const double passed_s = wall_s_ - wall_before_s, time_s = time_of_day(wall_s_);
  if (passed_s > 0 && passed_s <= kLongestStep_s)
    start_triggered(
        [&](const Trigger& trigger) {
          return trigger.kind == Kind::at &&
                 std::fmod(time_s - trigger.seconds + kDay_s, kDay_s) < passed_s;
        },
        false);
  if (next_ < count())
    for (const auto& trigger : cue(next_).triggers)
      if (trigger.kind == Kind::after && elapsed_s_ >= trigger.seconds) return start(next_);
}

void Deck::start(int at) {
  const auto& started = cue(at);
  current_ = at;
  next_ = after(at);
  is_held_ = false;
  elapsed_s_ = 0;
  retry_s_ = 0;
  started_s_ = wall_s_;
  source_ = fmt::format("cue {} {}", at + 1, quote(started.name));
  log::info("{} begins", source_);
  std::vector<std::string> switches;
  for (const auto& target : started.targets)
    if (target.numbers.empty()) switches.push_back(target.assignment);
  (void)change(switches);  // what is refused was named
  for (const auto& [hand, content] : started.content)
    if (const auto shown = panel_.show(hand, content, source_); !shown)
      complaints_.add(now_ns_, fmt::format("{}: {}", hand, shown.error().what));
  fades_.begin(started, panel_.controls(), *panel_.values());
  keep();
}

void Deck::fade() {
  if (fades_.are_over() || elapsed_s_ < retry_s_) return;
  const auto set = change(fades_.at(elapsed_s_, panel_.controls(), *panel_.values(), source_));
  if (set)
    fades_.were_set();
  else if (set.error().code == Errc::bad_config)
    fades_.stop();  // it would be refused again
  else
    retry_s_ = elapsed_s_ + kRetry_s;
  if (fades_.are_over()) keep();
}

void Deck::keep() {
  if (state_file_.empty()) return;
  const auto written =
      write_place(state_file_, {file_, cue(current_).name, started_s_, fades_.are_over()});
  if (!written) complaints_.add(now_ns_, written.error().what);
}

/// Goes on where the process before this one was.
void Deck::resume() {
  if (state_file_.empty()) return;
  const auto kept = read_place(state_file_);
  if (!kept) return complaints_.add(now_ns(), kept.error().what);
  if (!*kept || (*kept)->list != file_) return;
  started_s_ = (*kept)->started_s;
  elapsed_s_ = std::max(wall_s_ - started_s_, 0.0);
  if (go_to((*kept)->cue, (*kept)->is_faded)) log::info("the cue list goes on at {}", source_);
}

/// Goes on in a cue that was started before; false if there is no such cue. Fades that were not
/// over begin again.
bool Deck::go_to(std::string_view name, bool is_faded) {
  const auto found = std::ranges::find(list_->cues, name, &Cue::name);
  if (found == list_->cues.end()) return false;
  current_ = static_cast<int>(found - list_->cues.begin());
  next_ = after(current_);
  source_ = fmt::format("cue {} {}", current_ + 1, quote(found->name));
  if (is_faded) return true;
  elapsed_s_ = retry_s_ = 0;
  fades_.begin(*found, panel_.controls(), *panel_.values());
  return true;
}

/// Takes the list as the file has it now. One with faults changes nothing.
void Deck::read_again() {
  auto list = read_cues(file_, panel_.controls());
  if (!list) return complaints_.add(now_ns_, list.error().what + "; the cue list stays as it was");
  const auto name = current_ >= 0 ? cue(current_).name : "";
  const bool is_faded = fades_.are_over();
  fades_.stop();  // they refer to the old list
  {
    const std::lock_guard lock(mutex_);
    list_ = std::make_shared<const CueList>(std::move(*list));
  }
  if (!go_to(name, is_faded)) {
    next_ = std::clamp(current_, 0, count());
    current_ = -1;
  }
  has_new_names_ = true;
  log::info("the cue list was read again");
}

void Deck::publish() {
  double faded = 1;
  if (!fades_.are_over()) faded = std::min(elapsed_s_ / cue(current_).longest_fade_s(), 1.0);
  // Only this thread replaces it.
  if (place_ && !std::exchange(has_new_names_, false) && place_->current == current_ &&
      place_->next == next_ && place_->is_held == is_held_ && place_->faded == faded)
    return;
  auto place = std::make_shared<CuePlace>(CuePlace{{}, current_, next_, is_held_, faded});
  for (const auto& each : list_->cues) place->names.push_back(each.name);
  const std::lock_guard lock(mutex_);
  place_ = std::move(place);
}

}  // namespace
}  // namespace cues

double wall_clock_s() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

Result<std::unique_ptr<RunningCues>> open_cues(const config::Rig& rig,
                                               const std::filesystem::path& state_file,
                                               Panel& panel, WallClock clock) {
  const auto& file = rig.desk.cues;
  if (file.empty()) return nullptr;
  auto list = cues::read_cues(file, panel.controls());
  if (!list) return tl::make_unexpected(list.error());
  return std::make_unique<cues::Deck>(std::move(*list), file, state_file, panel, std::move(clock));
}

}  // namespace handcast::desk
