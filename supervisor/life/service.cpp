// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/service.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "supervisor/base/console.hpp"
#include "supervisor/base/process.hpp"

namespace handcast::supervisor {
namespace {

/// A read-only view of the ring of this stream; empty if there is none.
std::optional<ipc::RingView> look_at(std::string_view stream, const daemon::Rings& rings) {
  const auto fd = daemon::find_ring(rings, stream);
  if (!fd) return std::nullopt;
  auto view = ipc::RingView::open(UniqueFd(fcntl(*fd, F_DUPFD_CLOEXEC, 3)));
  if (view) return std::move(*view);
  log::warning("the ring {} cannot be observed: {}", stream, view.error().what);
  return std::nullopt;
}

}  // namespace

Service::Service(ServiceSpec spec, const Launch& launch, EventLoop& loop, OnNotice on_notice)
    : spec_(std::move(spec)),
      launch_(launch),
      loop_(loop),
      on_notice_(std::move(on_notice)),
      stream_(look_at(spec_.stream, launch.rings)) {}

Rules Service::rules() const {
  return {.name = spec_.name,
          .ready_ns = seconds_to_ns(spec_.ready_s > 0 ? spec_.ready_s : launch_.ready_s),
          .stop_ns = seconds_to_ns(launch_.stop_s),
          .silent_ns = seconds_to_ns(launch_.silent_s),
          .publishes = stream_.has_value(),
          .wants_standby = spec_.process.standby};
}

void Service::handle(const Event& event) { handle(event, launch_.now()); }

void Service::handle(const Event& event, std::int64_t now) {
  auto [state, actions] = next(std::move(state_), event, now, rules());
  state_ = std::move(state);
  log_.leave_out_known(state_.past.waits);
  if (!actions.empty()) ++revision_;
  std::vector<Event> caused;
  for (const auto& action : actions)
    if (auto effect = std::visit([this](const auto& each) { return carry_out(each); }, action))
      caused.push_back(std::move(*effect));
  if (!state_.replacement) wanted_.reset();
  for (const auto& each : caused) handle(each);
}

Service::MaybeEvent Service::carry_out(const action::Spawn&) {
  epoch_before_ = stream_ ? stream_->epoch() : 0;
  auto child = spawn(false);
  if (child) {
    watch_worker(std::move(*child));
    return {};
  }
  log_.append(child.error().what + "\n", print_line);
  return event::NotStarted{{.code = exit_code_of(child.error())}};
}

Service::MaybeEvent Service::carry_out(const action::Promote&) {
  epoch_before_ = stream_ ? stream_->epoch() : 0;
  watch_worker(standby_->promote());
  standby_.reset();
  take_wanted();
  return {};
}

Service::MaybeEvent Service::carry_out(const action::HandOver&) {
  epoch_before_ = stream_ ? stream_->epoch() : 0;  // before the new process may publish
  worker_->signal(SIGTERM);
  auto next = standby_->promote();
  auto before = worker_->release();
  watch_worker(std::move(next));
  watch_standby(std::move(before), standby_log_);  // its last words are not those of the new one
  take_wanted();
  return {};
}

void Service::take_wanted() {
  if (!wanted_) return;
  spec_ = std::move(wanted_->spec);
  backend_override_ = std::move(wanted_->swapped);
  wanted_.reset();
}

Service::MaybeEvent Service::carry_out(const action::AskToStop& ask) {
  worker_->signal(ask.for_good ? SIGINT : SIGTERM);
  return {};
}

Service::MaybeEvent Service::carry_out(const action::Kill&) {
  worker_->signal(SIGKILL);
  return {};
}

Service::MaybeEvent Service::carry_out(const action::SpawnStandby&) {
  standby_log_ = {};
  auto child = spawn(true);
  if (!child) return event::StandbyNotStarted{child.error().what};
  watch_standby(std::move(*child), standby_log_);
  return {};
}

Service::MaybeEvent Service::carry_out(const action::AskStandbyToStop&) {
  standby_->signal(SIGTERM);
  return {};
}

Service::MaybeEvent Service::carry_out(const action::KillStandby&) {
  standby_->signal(SIGKILL);
  return {};
}

Service::MaybeEvent Service::carry_out(const action::ReplacementFailed& failed) {
  const auto last = failed.by_itself ? standby_log_.last_sentence() : "";
  replacement_problem_ = last.empty() ? failed.why : last;
  return {};
}

Service::MaybeEvent Service::carry_out(const action::ReadLastWords&) {
  if (dead_) dead_->read_last_words();
  return {};
}

Service::MaybeEvent Service::carry_out(const action::Warn& warn) {
  log::warning("{}", warn.sentence);
  return {};
}

Service::MaybeEvent Service::carry_out(const action::Tell& tell) {
  on_notice_(*this, tell.notice);
  return {};
}

Result<Child> Service::spawn(bool standby) const {
  const auto with = standby && wanted_ ? *wanted_ : settings();
  const auto command = command_of(spec_, launch_.program_folder);
  std::vector<std::string> arguments(command.begin() + 1, command.end());
  arguments.insert(arguments.end(), {"--config", fmt::format("/proc/self/fd/{}", with.rig_fd)});
  if (!with.swapped.empty())
    arguments.insert(arguments.end(), {"--set", spec_.name + ".backend=" + with.swapped});
  return Child::spawn({.program = command.front(),
                       .arguments = std::move(arguments),
                       .rings = launch_.rings,
                       .epoch_ns = launch_.epoch_ns,
                       .rig = launch_.rig,
                       .state_fd = launch_.state_fd,
                       .rig_fd = with.rig_fd,
                       .standby = standby});
}

void Service::watch_worker(Child child) {
  const auto on_words = [this](daemon::Words words) {
    if (words.ready) handle(event::SaidReady{has_published()});
  };
  worker_ = std::make_unique<WatchedChild>(
      std::move(child), log_, loop_,
      WatchedChild::Listener{.on_words = on_words,
                             .on_end = [this](Exit exit) { worker_ended(exit); }});
}

void Service::watch_standby(Child child, LogTail& log) {
  standby_ = std::make_unique<WatchedChild>(
      std::move(child), log, loop_,
      WatchedChild::Listener{.on_words = [this](daemon::Words) { handle(event::StandbySpoke{}); },
                             .on_end = [this](Exit exit) { standby_ended(exit); }});
}

void Service::worker_ended(Exit exit) {
  dead_ = std::move(worker_);
  handle(event::Ended{exit});
  dead_.reset();
}

void Service::standby_ended(Exit exit) {
  standby_->read_last_words();
  standby_.reset();
  handle(event::StandbyEnded{exit});
}

bool Service::has_published() const { return stream_ && stream_->epoch() != epoch_before_; }

void Service::inherit(const SavedService& saved) {
  if (!saved.swapped.empty()) spec_.backend = backend_override_ = saved.swapped;
  spec_.fingerprint = saved.fingerprint;  // of the settings in use; the file may have changed
  handle(event::Inherited{saved.state, saved.restarts});
}

void Service::adopt(AdoptedProcess process) {
  const auto started_ns = start_ns_of(process.saved.started_ticks);
  watch_worker(Child::adopt(std::move(process), *launch_.keeper));
  handle(event::Adopted{started_ns});
}

void Service::prepare(Settings wanted, Replacement how, bool may_use_standby) {
  replacement_problem_.clear();
  wanted_ = std::move(wanted);
  handle(event::Prepare{how, may_use_standby});
}

bool Service::replacement_is_prepared() const {
  return state_.replacement && std::holds_alternative<standby::Prepared>(state_.standby);
}

std::optional<double> Service::pause_ms() const {
  if (!has_published()) return std::nullopt;
  return ns_to_ms(stream_->look().pause_ns);
}

void Service::restart() {
  replacement_problem_.clear();
  handle(event::Restart{});
}

void Service::use_backend(std::string backend, bool on_trial) {
  replacement_problem_.clear();
  spec_.backend = backend_override_ = std::move(backend);
  handle(event::Restart{on_trial});
}

void Service::update(ServiceSpec spec) {
  if (spec.backend != backend_override_) backend_override_.clear();
  spec_ = std::move(spec);
  ++revision_;
  handle(event::SettingsChanged{});
}

void Service::tick(std::int64_t now, const Look& look) {
  if (worker_) worker_->check_end();
  if (standby_) standby_->check_end();
  event::Tick tick{.published = has_published(),
                   .needs_are_ready = look.needs_are_ready,
                   .last_sign_ns = look.last_sign_ns};
  observe(now, look, tick);
  handle(tick, now);
}

/// Adds what a silent worker did since the last tick.
void Service::observe(std::int64_t now, const Look& look, event::Tick& tick) {
  const auto before = std::exchange(look_, {});
  const auto before_ns = std::exchange(looked_ns_, now);
  if (!worker_ || !is_suspicious(state_, look.last_sign_ns, now, rules())) return;
  look_ = launch_.look_at(worker_->pid());
  tick.activity = activity_between(before, look_);
  tick.held_up_ns = held_up_ns(before, look_, now - before_ns);
}

SavedService Service::saved() const {
  return {.name = spec_.name,
          .pid = pid(),
          .started_ticks = worker_ ? start_ticks_of(worker_->pid()).value_or(0) : 0,
          .state = state(),
          .swapped = backend_override_,
          .fingerprint = spec_.fingerprint,
          .restarts = restarts(),
          .log_inode = inode_of(log_fd())};
}

pid_t Service::standby_pid() const {
  return std::holds_alternative<standby::Prepared>(state_.standby) ? standby_->pid() : 0;
}

double Service::uptime_s(std::int64_t now) const {
  const auto* life = life_of(state_.worker);
  return life ? ns_to_seconds(now - life->started_ns) : 0;
}

std::optional<double> Service::retry_s(std::int64_t now) const {
  const auto* waiting = std::get_if<worker::Waiting>(&state_.worker);
  if (!waiting) return std::nullopt;
  return ns_to_seconds(std::max<std::int64_t>(waiting->due_ns - now, 0));
}

}  // namespace handcast::supervisor
