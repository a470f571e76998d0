// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/result.hpp"
#include "ipc/daemon/attached.hpp"
#include "ipc/daemon/description.hpp"
#include "ipc/daemon/supervision.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"
#include "services/runtime/live_settings.hpp"

/// The environment of a daemon: configuration, rings, readiness, heartbeat and stage marks. The
/// contract with the supervisor is in ipc/daemon/contract.hpp.
namespace handcast::service {

/// Logs the error and ends the daemon with the error's exit code.
[[noreturn]] void give_up(const Error& error);

/// The value of `result`. Calls give_up() if it is an error.
template <class T>
T must(Result<T> result) {
  if (!result) give_up(result.error());
  return std::move(*result);
}

/// The context of one daemon. One thread.
class Context {
 public:
  /// The configuration of the rig, with the live settings at the start of this process.
  const config::Rig& rig() const { return rig_; }
  /// The same as its file has it.
  const config::Rig& filed() const { return filed_; }
  /// What people change from now on. Errors: those of ring() and LiveSettings::follow().
  Result<std::unique_ptr<LiveSettings>> live_settings() const;
  /// The calibration of the rig.
  const calib::Calibration& calibration() const { return calibration_; }
  /// The time of the rig's start, the same for every daemon of the rig: time zero of the twin.
  std::int64_t epoch_ns() const { return supervision_.epoch_ns(); }

  /// The writer of a ring. A standby waits for its turn first (see stand_by()), and then until the
  /// worker that it replaces has left the ring. Errors: bad_config (the description does not name
  /// the ring, or there is none), those of ipc::Writer::attach().
  template <class T>
  Result<ipc::Writer<T>> writer(std::string_view stream) {
    stand_by();
    auto segment = take_segment(stream, description_.publishes);
    if (!segment) return tl::make_unexpected(segment.error());
    return ipc::Writer<T>::attach(std::move(*segment), writers_until_);
  }
  /// A reader of a ring. `wait`: how it waits for messages; empty: as set in [NAME.process].
  /// Errors: see writer().
  template <class T>
  Result<ipc::Reader<T>> reader(std::string_view stream,
                                std::optional<ipc::Wait> wait = std::nullopt) {
    auto segment = take_segment(stream, description_.subscribes);
    if (!segment) return tl::make_unexpected(segment.error());
    return ipc::Reader<T>::attach(std::move(*segment), wait.value_or(wait_));
  }

  /// The memory of a ring, for readers that only look on (ipc::Reader::watch()). Errors:
  /// bad_config (there is no such ring), those of ipc::Segment::open().
  Result<ipc::Segment> ring(std::string_view stream) const { return open_segment(stream); }

  /// Waits for the turn of a standby; returns at once in other processes. Call it after all
  /// preparations that two processes may do at the same time (models, pictures, memory) and before
  /// opening resources that only one process may use: writers, devices. The memory of the rings in
  /// the description is mapped before the wait. A daemon that does not call it waits in its first
  /// writer(), or in ready().
  void stand_by();
  /// Reports to the supervisor that the daemon works. Call it once, after all steps of the start
  /// that can fail.
  void ready();
  /// True until SIGTERM or SIGINT arrives. Publishes a heartbeat if one is due: call it at least
  /// every daemon::kBeatEvery_ns. Afterwards the daemon should first destroy its writers: the
  /// process that replaces it may be waiting for them.
  bool running();
  /// True if the daemon was asked to stop, but may end its work before (daemon::Stop::for_good):
  /// no process replaces it.
  bool may_finish() const;
  /// Handles an error of one turn of the main loop. Timeouts and bad data are counted and logged,
  /// the same sentence again after 1, 2, 4 s and so on, up to an hour; all other errors end the
  /// process, and the supervisor reacts.
  void tolerate(const Error& error);
  /// Publishes the times of the stages of one frame, for traces, reports and `handcast status`.
  /// `made_from`: the inputs of a projector frame.
  void mark(const msg::Header& frame, std::span<const msg::StageMark> stages,
            const msg::MadeFrom& made_from = {});

  /// Takes the handover from the environment.
  Context(const daemon::ServiceDescription& description, config::Rig rig,
          calib::Calibration calibration);

 private:
  Result<ipc::Segment> take_segment(std::string_view stream,
                                    const std::vector<std::string>& described);
  Result<ipc::Segment> open_segment(std::string_view stream) const;
  void open_marks();

  daemon::ServiceDescription description_;
  config::Rig filed_;  ///< as the file has it
  config::Rig rig_;
  calib::Calibration calibration_;
  daemon::Supervision supervision_;
  ipc::Wait wait_ = ipc::Wait::futex;
  Deadline writers_until_ = Deadline::now();  ///< how long a writer waits for the one before it
  std::map<std::string, ipc::Segment, std::less<>> mapped_;  ///< prepared by stand_by()
  std::unique_ptr<ipc::Writer<msg::StageMarks>> marks_;
  std::string complaint_;  ///< the last one that was logged
  std::int64_t next_complaint_ns_ = 0, complaint_pause_ns_ = 0;
  std::uint64_t complaints_ = 0;
};

/// Opens what a daemon opens at its start, but neither rings nor devices, and closes it again.
using Check = std::function<Result<void>(const config::Rig&, const calib::Calibration&)>;

/// A daemon as one of the services that its program can be: of a rig with two cameras, `camera` and
/// `camera2` are instances of handcast-camera.
struct Instance {
  /// Without the settings that every daemon reads (calibration, NAME.backend, [NAME.process]).
  daemon::ServiceDescription description;
  std::function<void(Context&)> body;  ///< its work
  Check check{};                       ///< what --check does; null: nothing of its own
  /// The devices that its back ends find, which --attached prints; null: it has no such option.
  std::function<std::vector<daemon::Attached>(const daemon::Search&)> attached{};
};

/// The main function of all daemons: parses the command line, loads the rig and runs the body, or,
/// with --check, the check, of the instance that --as names, or else of the first one. `program`:
/// the name of the program, if it is not that of the first instance. Returns the exit code.
int run(std::span<const Instance> instances, int argc, char** argv, std::string_view program = {});
/// The same for a program that is one service.
int run(const daemon::ServiceDescription& description, int argc, char** argv,
        const std::function<void(Context&)>& body, const Check& check = {});

/// The description of the service at a viewpoint, from that of the service at the first one: the
/// names of its rings, sections and settings are those of config::name_at().
daemon::ServiceDescription describe_at(config::Viewpoint at, daemon::ServiceDescription first);

}  // namespace handcast::service
