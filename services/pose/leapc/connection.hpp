// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "calib/clock_map.hpp"
#include "config/sections/leapc.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/pose/leapc/declarations.hpp"
#include "services/pose/leapc/library.hpp"

namespace handcast::pose::leapc {

/// The devices that the service has announced on one connection. One thread.
class Devices {
 public:
  /// `wanted`: the serial number of the device whose frames are asked for; empty: the service
  /// chooses. `call` must outlive it.
  Devices(const Functions& call, std::string wanted) : call_(call), wanted_(std::move(wanted)) {}
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;
  ~Devices() { clear(); }

  /// A device was attached: its serial number is read and logged; a wanted one is subscribed to.
  void attached(ConnectionHandle connection, const DeviceEvent& event);
  /// A device is gone.
  void lost(const DeviceEvent& event);
  /// The connection is gone, and all devices with it.
  void clear();

  /// Whether frames of this device, 0 if the message does not say, are to be used.
  bool is_wanted(std::uint32_t id) const;
  /// Why no frames can come; empty if they can.
  std::string trouble() const;

 private:
  struct Device {
    DeviceHandle handle = nullptr;  ///< open if it is subscribed to
    std::string serial;
  };

  std::string serial_of(DeviceHandle device) const;
  bool is_wanted(const Device& device) const { return wanted_.empty() || device.serial == wanted_; }

  const Functions& call_;
  std::string wanted_;
  std::map<std::uint32_t, Device> devices_;  ///< by the service's id
};

/// A tracking event with the hands of a rig. Nothing in it points into the library.
struct Tracked {
  std::int64_t frame_id = 0;
  std::int64_t stamp_us = 0;  ///< by the service's clock
  msg::HandPoses poses;       ///< without header; at most one hand of each side
};

/// Reads a message of kind kTracking. Of several hands of one side, the one that has been visible
/// for longest is taken. Errors (bad_data): memory that cannot be read, numbers that are not
/// finite, more hands than any device sees.
Result<Tracked> read_tracking(const Message& message);

/// The joints of one hand of the library. Errors: bad_data (a number is not finite, or no side).
Result<msg::HandPose> pose_of(const Hand& hand);

/// Maps the time stamps of Ultraleap's service to CLOCK_MONOTONIC with the library's clock rebaser.
/// A stamp that it maps to a time after the arrival, or to one that is long past, cannot be of the
/// service's clock; it is mapped by the lower envelope of the arrivals instead. One thread.
class HostClock {
 public:
  /// `least_age_ns`: of a sample when it arrives, for the lower envelope. `call` must outlive it.
  HostClock(const Functions& call, std::int64_t least_age_ns);
  HostClock(const HostClock&) = delete;
  HostClock& operator=(const HostClock&) = delete;
  ~HostClock();

  /// The time of a stamp that arrived at `arrival_ns`, CLOCK_MONOTONIC. Call it at the arrival.
  std::int64_t origin_ns(std::int64_t stamp_us, std::int64_t arrival_ns);

  /// True if the last stamp was mapped by its arrival.
  bool is_guessed() const { return is_guessed_; }

 private:
  std::int64_t rebased_age_ns(std::int64_t stamp_us, std::int64_t arrival_ns);

  const Functions& call_;
  std::int64_t least_age_ns_;
  RebaserHandle rebaser_ = nullptr;
  std::int64_t updated_ns_ = 0;
  calib::ClockMap arrivals_;
  bool is_guessed_ = false;
};

/// Holds the newest sample until it is taken, and says why there is none. Any thread.
class Mailbox {
 public:
  /// Replaces the sample, or the error, that is waiting.
  void put(Result<msg::HandPoses> sample);
  /// Why no samples come; empty: they should.
  void say(std::string trouble);
  /// The newest sample, as soon as there is one. Errors: timeout, with the trouble; the error that
  /// was put.
  Result<msg::HandPoses> take(Deadline deadline);

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::optional<Result<msg::HandPoses>> newest_;
  std::string trouble_;
};

/// A connection to Ultraleap's service, polled on a thread of its own. Makes it anew if the service
/// was away. Leaves samples, and why there are none, in a mailbox.
class Connection {
 public:
  /// `first_id`: number of the first sample. `mailbox` must outlive it.
  Connection(Library library, const config::Leapc& settings, std::uint64_t first_id,
             Mailbox& mailbox);

  /// True if a call of the library has not returned for 2 s. Any thread.
  bool hangs() const;

 private:
  void run(const std::stop_token& stop);
  bool create();
  void connect();
  void disconnect();
  void poll();
  void read(const Message& message);
  void begin();
  void device_event(const Message& message);
  void mode_event(const Message& message);
  void track(const Message& message);
  std::uint64_t next_id(std::int64_t frame);
  void lose_service();
  void say_state();

  Library library_;
  config::Leapc settings_;
  Mailbox& mailbox_;
  HostClock clock_;
  Devices devices_;
  ConnectionHandle handle_ = nullptr;
  bool is_up_ = false;                ///< the service has answered
  std::int64_t silent_since_ns_ = 0;  ///< without an answer of the service
  std::string trouble_, said_;        ///< why there are no frames: now, and as it was logged
  std::int64_t trouble_since_ns_ = 0;
  bool has_said_guess_ = false;
  std::uint64_t next_id_;
  std::optional<std::uint64_t> last_frame_;  ///< the service's number
  std::int64_t last_origin_ns_ = 0;
  std::atomic<std::int64_t> turn_ns_;  ///< when the turn of the thread began
  std::jthread thread_;
};

}  // namespace handcast::pose::leapc
