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
#include "ipc/daemon/description.hpp"
#include "ipc/daemon/supervision.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"

/// What a daemon stands on: its configuration, its rings, its readiness, its heart-beat, its stage
/// marks. The contract with the supervisor is in ipc/daemon/contract.hpp.
namespace handcast::service {

/// Ends a daemon with the error's sentence in the log and the error's exit code.
[[noreturn]] void give_up(const Error& error);

/// The value, or the end of the daemon: give_up().
template <class T>
T must(Result<T> result) {
  if (!result) give_up(result.error());
  return std::move(*result);
}

/// One daemon at work. One thread.
class Context {
 public:
  const config::Rig& rig() const { return rig_; }
  const calib::Calibration& calibration() const { return calibration_; }
  /// The time of the rig's start, the same for every daemon of the rig: time zero of the twin.
  std::int64_t epoch_ns() const { return supervision_.epoch_ns(); }

  /// The ring's writer. A spare gets it in its turn: see stand_by(). Errors: bad_config (the
  /// description does not name the ring, or there is none), those of ipc::Writer::attach().
  template <class T>
  Result<ipc::Writer<T>> writer(std::string_view stream) {
    stand_by();
    auto segment = take_segment(stream, description_.publishes);
    if (!segment) return tl::make_unexpected(segment.error());
    return ipc::Writer<T>::attach(std::move(*segment));
  }
  /// A reader of the ring. Without a `wait`: as the service's [NAME.process] says. Errors: see
  /// writer().
  template <class T>
  Result<ipc::Reader<T>> reader(std::string_view stream,
                                std::optional<ipc::Wait> wait = std::nullopt) {
    auto segment = take_segment(stream, description_.subscribes);
    if (!segment) return tl::make_unexpected(segment.error());
    return ipc::Reader<T>::attach(std::move(*segment), wait.value_or(wait_));
  }

  /// A spare waits here for its turn, everybody else passes. Call it after all preparation that a
  /// second process may do at the same time (models, pictures, memory), before what only one may
  /// have: writers, devices. The memory of the rings in its description is mapped before the wait.
  /// A daemon that never calls it waits at its first writer, or in ready().
  void stand_by();
  /// Tells the supervisor that the daemon works: call it once, after everything that can fail at
  /// start-up.
  void ready();
  /// False after SIGTERM or SIGINT. Beats the heart: call it at least every daemon::kBeatEvery_ns.
  bool running();
  /// An error of one turn of the loop: timeouts and bad items are counted (and logged, at most once
  /// a second); a lost device or a bad configuration ends the process for the supervisor to act on.
  void tolerate(const Error& error);
  /// Publishes what one frame's stages took, for traces, the report and `handcast status`.
  /// `made_from`: of a projector frame.
  void mark(const msg::Header& frame, std::span<const msg::StageMark> stages,
            const msg::MadeFrom& made_from = {});

  Context(const daemon::ServiceDescription& description, config::Rig rig,
          calib::Calibration calibration);

 private:
  Result<ipc::Segment> take_segment(std::string_view stream,
                                    const std::vector<std::string>& described);
  Result<ipc::Segment> open_segment(std::string_view stream) const;
  void open_marks();

  daemon::ServiceDescription description_;
  config::Rig rig_;
  calib::Calibration calibration_;
  daemon::Supervision supervision_;
  ipc::Wait wait_ = ipc::Wait::futex;
  std::map<std::string, ipc::Segment, std::less<>> mapped_;  ///< a spare's, not asked for yet
  std::unique_ptr<ipc::Writer<msg::StageMarks>> marks_;
  std::int64_t last_complaint_ns_ = 0;
  std::uint64_t complaints_ = 0;
};

/// A daemon's description, completed with what every daemon reads: the calibration, its back end's
/// name and its [NAME.process].
daemon::ServiceDescription complete(daemon::ServiceDescription description);

/// The main of every daemon: parses the command line, loads the rig, runs `body`, turns its errors
/// into exit codes. `description` needs not be complete().
int run(const daemon::ServiceDescription& description, int argc, char** argv,
        const std::function<void(Context&)>& body);

}  // namespace handcast::service
