// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ipc/ring/ring_view.hpp"
#include "supervisor/base/event_loop.hpp"
#include "supervisor/life/log_tail.hpp"
#include "supervisor/life/next.hpp"
#include "supervisor/life/saved_service.hpp"
#include "supervisor/life/watched_child.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {

/// What every service of a rig is started with.
struct Launch {
  std::filesystem::path program_folder;
  std::filesystem::path rig_file;
  daemon::Rings rings;
  std::int64_t epoch_ns = 0;
  double ready_s = 10, stop_s = 3, silent_s = 2;
  ExitReports* reports = nullptr;  ///< for processes of an earlier supervisor
};

/// One service over its many lives: its worker and its spare on the event loop. Ready is a service
/// that said so and, if it publishes a stream, has published its first message.
///
/// Nothing is decided here. What happens becomes an event, next() (next.hpp) says what follows, and
/// the actions are carried out. One thread, that of the event loop.
class Service {
 public:
  using OnNotice = std::function<void(Service&, Notice)>;

  /// `launch` and `loop` must outlive the object.
  Service(ServiceSpec spec, const Launch& launch, EventLoop& loop, OnNotice on_notice);
  Service(const Service&) = delete;

  /// It will be started when its needs are met: State::starting until then.
  void hold() { handle(event::Hold{}); }
  void start() { handle(event::Start{}); }
  /// Takes what an earlier supervisor knew of it: one that had failed or stopped stays so. Call it
  /// before `adopt` and `start`.
  void inherit(const SavedService& saved);
  /// Goes on with a ready process that an earlier supervisor started.
  void adopt(AdoptedProcess process);
  /// Asks it to stop, and kills it after stop_s. Notice::stopped follows, at once if nothing runs.
  void stop() { handle(event::Stop{}); }
  /// Kills what was asked to stop.
  void hurry() { handle(event::Hurry{}); }
  /// Stops it and starts it again.
  void restart() { handle(event::Restart{}); }
  /// Restarts it with another back end. On trial, a death before it is ready is final:
  /// Notice::failed.
  void use_backend(std::string backend, bool on_trial);
  /// Takes new settings, with which it will be started the next time. A back end other than the
  /// swapped one is the rig file's.
  void update(ServiceSpec spec);

  /// What the rig sees of a service.
  struct Look {
    bool needs_are_ready = true;             ///< the services that it needs
    std::optional<std::int64_t> heard_ns{};  ///< its last sign of life; empty: there was none
  };
  /// Acts on what is due. Call it a few dozen times a second.
  void tick(std::int64_t now_ns, const Look& look);
  /// The supervisor, or the machine, stood still for this long: nobody is late for it.
  void forgive(std::int64_t span_ns) { handle(event::StoodStill{span_ns}); }

  /// For the supervisor's successor.
  SavedService saved() const;
  /// Counts up whenever saved() may have changed.
  std::uint64_t revision() const { return revision_; }

  const ServiceSpec& spec() const { return spec_; }
  State state() const { return shown(state_.worker); }
  /// Of the worker; 0: there is none.
  pid_t pid() const { return worker_ ? worker_->pid() : 0; }
  /// Of a spare that can be promoted; 0: there is none.
  pid_t spare_pid() const;
  bool is_running() const { return worker_ || spare_; }
  /// Whether it waits to be begun.
  bool is_held() const { return std::holds_alternative<worker::Held>(state_.worker); }
  double uptime_s(std::int64_t now_ns) const;
  /// When it was begun; empty: it never was.
  std::optional<std::int64_t> first_start_ns() const { return state_.past.first_start_ns; }
  int restarts() const { return state_.past.restarts; }
  /// Whether it has been ready in this or an earlier life.
  bool was_ready() const { return state_.past.was_ready; }
  const std::optional<Exit>& last_exit() const { return state_.past.last_exit; }
  const LogTail& log() const { return log_; }
  /// Within the minute before the last.
  std::size_t recent_deaths() const { return state_.past.deaths.recent_ns.size(); }
  /// Until it is started again; empty if that is not due.
  std::optional<double> retry_s(std::int64_t now_ns) const;

 private:
  using MaybeEvent = std::optional<Event>;

  Rules rules() const;
  void handle(const Event& event);
  void handle(const Event& event, std::int64_t now_ns);

  // Each carries an action out. What comes of it at once is a new event.
  MaybeEvent carry_out(const action::Spawn&);
  MaybeEvent carry_out(const action::Promote&);
  MaybeEvent carry_out(const action::AskToStop&);
  MaybeEvent carry_out(const action::Kill&);
  MaybeEvent carry_out(const action::SpawnSpare&);
  MaybeEvent carry_out(const action::AskSpareToStop&);
  MaybeEvent carry_out(const action::KillSpare&);
  MaybeEvent carry_out(const action::ReadLastWords&);
  MaybeEvent carry_out(const action::Warn& warn);
  MaybeEvent carry_out(const action::Tell& tell);

  Result<Child> spawn(bool spare) const;
  void watch_worker(Child child);
  void worker_ended(Exit exit);
  void spare_ended(Exit exit);
  bool has_published() const;

  ServiceSpec spec_;
  const Launch& launch_;
  EventLoop& loop_;
  OnNotice on_notice_;
  std::string backend_override_;  ///< `swap` put it in the place of the rig file's; "" for none

  ServiceState state_;
  std::uint64_t revision_ = 0;

  LogTail log_, spare_log_;
  std::unique_ptr<WatchedChild> worker_, spare_;
  std::unique_ptr<WatchedChild> dead_;   ///< a worker that has ended, until its last words are read
  std::optional<ipc::RingView> stream_;  ///< of what it publishes
  std::uint64_t epoch_before_ = 0;       ///< of the stream, before this worker could publish
};

}  // namespace handcast::supervisor
