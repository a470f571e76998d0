// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/ring/ring_view.hpp"
#include "supervisor/base/event_loop.hpp"
#include "supervisor/life/log_tail.hpp"
#include "supervisor/life/next.hpp"
#include "supervisor/life/process_activity.hpp"
#include "supervisor/life/saved_service.hpp"
#include "supervisor/life/watched_child.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {

/// The parameters with which all services of a rig are started.
struct Launch {
  std::filesystem::path program_folder;  ///< folder of the daemons' executables
  int rig_fd = -1;                       ///< the applied rig file, --config of the daemons
  daemon::Rings rings;                   ///< the rings that they inherit
  std::int64_t epoch_ns = 0;             ///< HANDCAST_EPOCH_NS
  std::string rig;                       ///< HANDCAST_RIG
  int state_fd = -1;                     ///< HANDCAST_STATE_FD
  /// Time limits: see Rules.
  /// @{
  double ready_s = 10, stop_s = 3, silent_s = 2;
  /// @}
  KeeperLink* keeper = nullptr;  ///< tells the ends of processes of an earlier supervisor
  /// The clock and the view of processes; a test has its own.
  /// @{
  std::function<std::int64_t()> now = now_ns;
  std::function<std::optional<ProcessLook>(pid_t)> look_at = look_at_process;
  /// @}
};

/// The settings of a service's process.
struct Settings {
  ServiceSpec spec;       ///< the specification
  std::string swapped{};  ///< the back end set by `handcast swap`; "": that of the rig file
  int rig_fd = -1;        ///< the rig file, --config of the daemon
};

/// One service: its worker and its standby on the event loop, over all restarts. A service is ready
/// when its worker has reported so and, if it publishes a stream, has published its first message.
///
/// This class makes no decisions: it passes events to next() (next.hpp) and carries out the
/// resulting actions. One thread, that of the event loop.
class Service {
 public:
  /// Called when the service becomes ready, stops or fails.
  using OnNotice = std::function<void(Service&, Notice)>;

  /// `launch` and `loop` must outlive the object.
  Service(ServiceSpec spec, const Launch& launch, EventLoop& loop, OnNotice on_notice);
  Service(const Service&) = delete;

  /// Marks the service to be started when its needs are met (State::starting). The rig calls
  /// start().
  void hold() { handle(event::Hold{}); }
  /// Starts the worker. Does nothing if there is one.
  void start() { handle(event::Start{}); }
  /// Restores the state saved by an earlier supervisor: a service that had failed or stopped stays
  /// failed or stopped. Call it before adopt() and start().
  void inherit(const SavedService& saved);
  /// Takes over a ready process that an earlier supervisor started.
  void adopt(AdoptedProcess process);
  /// Asks the service to stop, and kills it after stop_s. Notice::stopped follows, immediately if
  /// no process runs.
  void stop() { handle(event::Stop{}); }
  /// Kills the processes that were asked to stop.
  void hurry() { handle(event::Hurry{}); }

  /// Starts a replacement with these settings while the worker goes on. If `may_use_standby` is
  /// set, a standby that exists becomes the replacement. See replacement_is_prepared() and
  /// has_replacement().
  void prepare(Settings wanted, Replacement how, bool may_use_standby);
  /// Replaces the worker by its replacement, if that is prepared. Its settings become those of the
  /// service. Notice::ready follows, or, if it fails on trial, Notice::failed.
  void hand_over() { handle(event::HandOver{}); }
  /// Ends the replacement; the worker goes on.
  void abandon() { handle(event::Abandon{}); }
  /// True from prepare() until the replacement takes over or fails.
  bool has_replacement() const { return state_.replacement.has_value(); }
  /// True if hand_over() would replace the worker.
  bool replacement_is_prepared() const;
  /// Why the last replacement failed; "" if it did not.
  const std::string& replacement_problem() const { return replacement_problem_; }
  /// True if the worker works: it can be replaced without a pause.
  bool works() const { return std::holds_alternative<worker::Ready>(state_.worker); }
  /// The settings that the service is started with.
  Settings settings() const { return {spec_, backend_override_, launch_.rig_fd}; }
  /// The time between the last message of the previous worker and the first one of this worker;
  /// empty if the service publishes no stream, or this worker has not published yet.
  std::optional<double> pause_ms() const;

  /// Stops the service and starts it again.
  void restart();
  /// Restarts the service with another back end. If `on_trial` is set, it is not restarted when it
  /// dies before it is ready: Notice::failed follows.
  void use_backend(std::string backend, bool on_trial);
  /// Replaces the settings, which apply from the next start on. If `spec` has another back end than
  /// use_backend() set, that of `spec` applies.
  void update(ServiceSpec spec);

  /// The rig's view of a service at one moment.
  struct Look {
    bool needs_are_ready = true;  ///< the services that it needs are ready
    /// The time of its last frame or heartbeat; empty if there was none.
    std::optional<std::int64_t> last_sign_ns{};
  };
  /// Checks all time limits and waits. Call it a few dozen times per second.
  void tick(std::int64_t now_ns, const Look& look);
  /// Extends all time limits by the time for which the supervisor, or the machine, stood still.
  void forgive(std::int64_t span_ns) { handle(event::StoodStill{span_ns}); }

  /// The state for a successor of the supervisor.
  SavedService saved() const;
  /// Incremented whenever saved() may have changed.
  std::uint64_t revision() const { return revision_; }

  /// The settings. Their back end is the one set by use_backend(), if any.
  const ServiceSpec& spec() const { return spec_; }
  /// The state of the worker.
  State state() const { return shown(state_.worker); }
  /// The pid of the worker; 0 if there is none.
  pid_t pid() const { return worker_ ? worker_->pid() : 0; }
  /// The reading end of the worker's output; -1: none.
  int log_fd() const { return worker_ ? worker_->log_fd() : -1; }
  /// The pid of a standby that can be promoted; 0 if there is none.
  pid_t standby_pid() const;
  /// True if there is a process, worker or standby.
  bool is_running() const { return worker_ || standby_; }
  /// True between hold() and start().
  bool is_held() const { return std::holds_alternative<worker::Held>(state_.worker); }
  /// Time since the worker was started; 0 if there is none.
  double uptime_s(std::int64_t now_ns) const;
  /// When the service was first started; empty if it never was.
  std::optional<std::int64_t> first_start_ns() const { return state_.past.first_start_ns; }
  /// Number of restarts after a death, those under earlier supervisors included.
  int restarts() const { return state_.past.restarts; }
  /// True if this or an earlier worker has been ready.
  bool was_ready() const { return state_.past.was_ready; }
  /// How the last worker ended; empty if none has.
  const std::optional<Exit>& last_exit() const { return state_.past.last_exit; }
  /// The newest output of the workers.
  const LogTail& log() const { return log_; }
  /// Number of deaths in the minute before the last death, which is included.
  std::size_t recent_deaths() const { return state_.past.deaths.recent_ns.size(); }
  /// Time until the next restart; empty if none is due.
  std::optional<double> retry_s(std::int64_t now_ns) const;

 private:
  using MaybeEvent = std::optional<Event>;

  Rules rules() const;
  void handle(const Event& event);
  void handle(const Event& event, std::int64_t now_ns);

  // Each carries out an action and returns the event that it causes at once, if any.
  MaybeEvent carry_out(const action::Spawn&);
  MaybeEvent carry_out(const action::Promote&);
  MaybeEvent carry_out(const action::HandOver&);
  MaybeEvent carry_out(const action::AskToStop& ask);
  MaybeEvent carry_out(const action::Kill&);
  MaybeEvent carry_out(const action::SpawnStandby&);
  MaybeEvent carry_out(const action::AskStandbyToStop&);
  MaybeEvent carry_out(const action::KillStandby&);
  MaybeEvent carry_out(const action::ReplacementFailed& failed);
  MaybeEvent carry_out(const action::ReadLastWords&);
  MaybeEvent carry_out(const action::Warn& warn);
  MaybeEvent carry_out(const action::Tell& tell);

  Result<Child> spawn(bool standby) const;
  void watch_worker(Child child);
  void watch_standby(Child child, LogTail& log);
  void take_wanted();
  void observe(std::int64_t now_ns, const Look& look, event::Tick& tick);
  void worker_ended(Exit exit);
  void standby_ended(Exit exit);
  bool has_published() const;

  ServiceSpec spec_;
  const Launch& launch_;
  EventLoop& loop_;
  OnNotice on_notice_;
  std::string backend_override_;  ///< set by use_backend(); "": the back end of the rig file

  ServiceState state_;
  std::uint64_t revision_ = 0;
  std::optional<Settings> wanted_;  ///< the settings of the replacement, if there is one
  std::string replacement_problem_;
  std::optional<ProcessLook> look_;  ///< the last look at a silent worker
  std::int64_t looked_ns_ = 0;       ///< when that was

  LogTail log_, standby_log_;
  std::unique_ptr<WatchedChild> worker_, standby_;
  std::unique_ptr<WatchedChild> dead_;   ///< a worker that has ended, until its output is read
  std::optional<ipc::RingView> stream_;  ///< the ring that it publishes
  std::uint64_t epoch_before_ = 0;       ///< epoch of the ring before this worker could publish
};

}  // namespace handcast::supervisor
