// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ipc/ring/ring_view.hpp"
#include "supervisor/base/event_loop.hpp"
#include "supervisor/life/child.hpp"
#include "supervisor/life/log_tail.hpp"
#include "supervisor/life/restart_policy.hpp"
#include "supervisor/life/saved_service.hpp"
#include "supervisor/life/standby.hpp"
#include "supervisor/life/state.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {

/// What every service of a rig is started with.
struct Launch {
  std::filesystem::path program_folder;
  std::filesystem::path rig_file;
  std::vector<std::pair<std::string, int>> rings;  ///< stream and descriptor
  std::int64_t epoch_ns = 0;
  double ready_s = 10, stop_s = 3, silent_s = 2;
  ExitReports* reports = nullptr;  ///< for processes of an earlier supervisor
};

/// One service over its many lives: starts it, sees that it gets ready, starts it again when it
/// dies, stops it. Ready is a service that said so and, where it publishes a stream, has published
/// its first message.
class Service {
 public:
  enum class Event { ready, stopped, failed };
  using OnEvent = std::function<void(Service&, Event)>;

  Service(ServiceSpec spec, const Launch& launch, EventLoop& loop, OnEvent on_event);
  ~Service();
  Service(const Service&) = delete;

  /// It will be started when its needs are met: State::starting until then.
  void hold();
  void start();
  /// Takes what an earlier supervisor knew of it: one that had failed or stopped stays so. Call it
  /// before `adopt` and `start`.
  void inherit(const SavedService& saved);
  /// Goes on with a process that an earlier supervisor started, as ready as it was.
  void adopt(AdoptedProcess process);
  void
  stop();  ///< asks, and kills after stop_s; Event::stopped follows, at once where nothing runs
  void kill();     ///< for those who do not want to wait
  void restart();  ///< stop and start
  /// restart with another back end. On trial, a death before it is ready is final: Event::failed.
  void use_backend(std::string backend, bool on_trial);
  /// Takes new settings: from its next life on. `reload` restarts it then, unless only the
  /// supervisor reads what changed. A back end other than the swapped one is the rig file's.
  void update(ServiceSpec spec);
  /// Acts on what is due. Call it a few dozen times a second. A service whose needs are not ready
  /// may wait with its first message.
  void tick(std::int64_t now_ns, bool needs_are_ready = true);
  /// The supervisor, or the whole machine, stood still for this long: nobody is late for it.
  void forgive(std::int64_t span_ns);

  /// For the supervisor's successor.
  SavedService saved() const;
  /// Counts up whenever saved() changes.
  std::uint64_t revision() const { return revision_; }

  const ServiceSpec& spec() const { return spec_; }
  State state() const { return state_; }
  pid_t pid() const { return child_ ? child_->pid() : 0; }
  pid_t spare_pid() const {
    return standby_.is_prepared() ? standby_.pid() : 0;
  }  ///< 0: none is prepared
  bool is_running() const { return child_ || standby_.is_running(); }
  double uptime_s(std::int64_t now_ns) const {
    return child_ ? static_cast<double>(now_ns - started_ns_) * 1e-9 : 0;
  }
  std::optional<std::int64_t> ready_ns() const { return ready_ns_; }  ///< since when, in this life
  std::optional<std::int64_t> first_start_ns() const {
    return first_start_;
  }  ///< empty: it was never started
  int restarts() const { return restarts_; }
  bool ever_ready() const { return ever_ready_; }
  std::int64_t killed_ns() const { return killed_ns_; }  ///< when kill() was last called; 0: never
  const std::optional<Exit>& last_exit() const { return last_exit_; }
  const LogTail& log() const { return log_; }
  std::size_t recent_deaths() const {
    return deaths_.recent_ns.size();
  }  ///< within the minute before the last
  /// Until it is started again; empty where that is not due.
  std::optional<double> retry_s(std::int64_t now_ns) const;

 private:
  static constexpr auto kNever = std::numeric_limits<std::int64_t>::max();

  /// The newest message of its stream, before this life could add one.
  struct StreamMark {
    std::uint64_t epoch = 0, sequence = 0;
  };

  Result<Child> spawn(bool spare) const;
  std::vector<std::string> arguments() const;
  StreamMark stream_mark() const;
  bool has_published() const;

  void begin_life();
  void take(Child child);
  void read_log(const Child& child, int most_reads = LogTail::kReadsAtOnce);
  void read_ready();
  void expect_first_message(std::int64_t now_ns, bool needs_are_ready);
  void became_ready();
  void prepare_spare();

  void child_ended();
  void let_go(const Child& child);
  void stopped();
  Decision judge(Exit exit);
  void tell(Exit exit, const Decision& decision);
  void log_death(Exit exit, const Decision& decision) const;
  void note_failed_start(const Error& error);

  ServiceSpec spec_;
  const Launch& launch_;
  EventLoop& loop_;
  OnEvent on_event_;
  std::optional<ipc::RingView> stream_;  ///< of what it publishes
  Standby standby_;

  std::optional<Child> child_;
  State state_ = State::stopped;
  LogTail log_;
  DeathRecord deaths_;
  std::optional<Exit> last_exit_;
  std::optional<std::int64_t> ready_ns_, first_start_;
  std::int64_t started_ns_ = 0;
  std::int64_t killed_ns_ = 0;
  std::int64_t due_ns_ = kNever;  ///< starting: too late to say it is ready, or time to start
                                  ///< again; stopping: time to kill
  bool said_ready_ = false;
  bool adopted_ = false;
  bool promoted_ = false;
  StreamMark before_;
  std::int64_t dry_ns_ =
      0;  ///< how long it said it was ready and published nothing while its needs were ready
  std::int64_t last_tick_ns_ = 0;
  std::string backend_override_;  ///< `swap` put it in the place of the rig file's; "" for none
  bool start_when_stopped_ = false;
  bool on_trial_ = false;
  bool ever_ready_ = false;
  int restarts_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace handcast::supervisor
