// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <termios.h>

#include <optional>
#include <string>

#include "calib/calibration.hpp"
#include "calib/solve/board/grey_view.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/tools/calibrate/options.hpp"
#include "services/tools/calibrate/programs.hpp"
#include "services/tools/calibrate/session.hpp"
#include "services/tools/calibrate/test_screen.hpp"

namespace handcast::calibrate {

/// A key of the terminal.
struct Key {
  enum class Arrow { none, up, down, left, right };
  char character = 0;  ///< "\n" for Enter; 0 for an arrow
  Arrow arrow = Arrow::none;
};

/// The keys that a person presses in the terminal, without waiting for Enter. Ctrl-C is none of
/// them: see not_stopped(). Without a terminal there are none. One object at a time.
class Keys {
 public:
  Keys();
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;
  ~Keys() { restore(); }

  /// Gives the terminal back as it was; there are no keys afterwards.
  void restore();

  /// True if there is a person to press keys.
  bool has_person() const { return before_.has_value(); }
  /// Asks, and waits for Enter (true) or s (false); true without a person. Error unavailable: the
  /// program was asked to stop.
  Result<bool> confirm(const char* question);
  /// The next key that was pressed; empty if none was. Does not wait.
  std::optional<Key> pressed();

 private:
  std::optional<char> next_byte();

  std::optional<termios> before_;  ///< the terminal's state; empty without a terminal
};

/// What a step works with: the rig that runs, and the person at the terminal and in the light.
struct Desk {
  const Options& options;
  const config::Rig& rig;
  const calib::Calibration& used;  ///< what the services of the rig work with
  calib::Calibration& draft;       ///< what is being measured
  OwnRig& own_rig;
  TestScreen& screen;
  Keys& keys;
};

/// The image of a frame. Valid as long as the frame.
inline calib::GreyView view_of(const msg::CameraFrame& frame) {
  const auto width = static_cast<int>(frame.width_px);
  return {frame.pixels(), width, static_cast<int>(frame.height_px), width};
}

/// Tells a person how a measurement goes: a line in the terminal that is written over, and text on
/// the projector.
class Progress {
 public:
  /// `desk` must outlive the object.
  Progress(Desk& desk, std::string title);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();  ///< Ends the line in the terminal.

  /// Shows how far it is (0..1) and what to do next.
  void show(double share, const std::string& advice);
  /// The same in the terminal alone, while the projector shows something else.
  void say(double share, const std::string& advice);
  /// A sentence on a line of its own in the terminal.
  void note(const std::string& sentence);
  /// False if the step must end: Enter was pressed, its time is over, the rig has ended or a stream
  /// has failed. Looks after the rig.
  bool goes_on();
  /// The newest message of a stream that was not seen yet, or with next() the next one; empty if
  /// none came within 0.2 s, or if the stream has failed.
  /// @{
  template <class Message>
  std::optional<ipc::Sample<Message>> latest(client::Stream<Message>& stream) {
    return taken(stream.latest(Deadline::in(kPatience)));
  }
  template <class Message>
  std::optional<ipc::Sample<Message>> next(client::Stream<Message>& stream) {
    return taken(stream.next(Deadline::in(kPatience)));
  }
  /// @}
  /// The error that has ended the step, if one has.
  const Result<void>& result() const { return result_; }

 private:
  static constexpr std::chrono::milliseconds kPatience{200};

  template <class Message>
  std::optional<Message> taken(Result<Message>&& message) {
    if (message) return std::move(*message);
    if (message.error().code != Errc::timeout) result_ = tl::make_unexpected(message.error());
    return std::nullopt;
  }

  Desk& desk_;
  std::string title_;
  Result<void> result_;
  Deadline end_;
  std::int64_t printed_ns_ = 0;
  bool is_terminal_;
};

}  // namespace handcast::calibrate
