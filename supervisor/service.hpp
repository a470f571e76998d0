#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "supervisor/child.hpp"
#include "supervisor/event_loop.hpp"
#include "supervisor/log_tail.hpp"
#include "supervisor/restart_policy.hpp"
#include "supervisor/streams.hpp"

namespace handcast::supervisor {

/// What every service of a rig is started with.
struct Launch {
  std::filesystem::path program_folder;
  std::filesystem::path rig_file;
  std::vector<std::string> settings;
  std::vector<std::pair<std::string, int>> rings;  ///< stream and descriptor
  std::int64_t epoch_ns = 0;
  double ready_s = 10, stop_s = 3;
};

enum class State {
  stopped,   ///< as asked, or its work is done
  starting,  ///< started and not ready, or about to be started again
  ready,
  stopping,
  degraded,  ///< dies too often; retried slowly
  failed     ///< a person must change something; not retried
};
std::string_view name_of(State state);

/// One service over its many lives: starts it, sees that it gets ready, starts it again when it dies, stops it.
class Service {
 public:
  enum class Event { ready, stopped, failed };
  using OnEvent = std::function<void(Service&, Event)>;

  Service(ServiceSpec spec, const Launch& launch, EventLoop& loop, OnEvent on_event);
  ~Service();
  Service(const Service&) = delete;

  void start();
  void stop();     ///< asks, and kills after stop_s; Event::stopped follows, at once where nothing runs
  void kill();     ///< for those who do not want to wait
  void restart();  ///< stop and start
  /// restart with another back end. On trial, a death before it is ready is final: Event::failed.
  void use_backend(std::string backend, bool on_trial);
  /// Acts on what is due. Call it a few dozen times a second.
  void tick(std::int64_t now_ns);

  const ServiceSpec& spec() const { return spec_; }
  State state() const { return state_; }
  pid_t pid() const { return child_ ? child_->pid() : 0; }
  double uptime_s(std::int64_t now_ns) const { return child_ ? static_cast<double>(now_ns - started_ns_) * 1e-9 : 0; }
  int restarts() const { return restarts_; }
  bool ever_ready() const { return ever_ready_; }
  const std::optional<Exit>& last_exit() const { return last_exit_; }
  const LogTail& log() const { return log_; }

 private:
  static constexpr auto kNever = std::numeric_limits<std::int64_t>::max();

  void read_log();
  void read_ready();
  void child_ended();
  void life_ended(Exit exit);
  void bury(Exit exit);
  std::vector<std::string> arguments() const;

  ServiceSpec spec_;
  const Launch& launch_;
  EventLoop& loop_;
  OnEvent on_event_;

  std::optional<Child> child_;
  State state_ = State::stopped;
  LogTail log_;
  DeathRecord deaths_;
  std::optional<Exit> last_exit_;
  std::optional<std::int64_t> ready_ns_;  ///< of this life
  std::int64_t started_ns_ = 0;
  std::int64_t due_ns_ = kNever;  ///< starting: too late to be ready, or time to start again; stopping: time to kill
  std::string backend_override_;
  bool start_when_stopped_ = false;
  bool on_trial_ = false;
  bool ever_ready_ = false;
  bool ever_started_ = false;
  int restarts_ = 0;
};

}  // namespace handcast::supervisor
