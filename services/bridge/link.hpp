// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "config/sections/bridge.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/live_settings.hpp"
#include "services/bridge/clock_map.hpp"
#include "services/bridge/gate.hpp"

namespace handcast::bridge {

/// Who takes what comes from other computers. Nothing of it was checked, except that texts are
/// printable; times are those of the other computer.
class Receiver {
 public:
  virtual ~Receiver() = default;
  virtual void take(const Claim& claim, const msg::HandPoses& poses) = 0;
  virtual void take(const Claim& claim, const msg::Landmarks& landmarks) = 0;
  /// `values`: msg::LiveSettings::values.
  virtual void take(const Claim& claim, std::string_view values) = 0;
  /// What a peer answered to Link::ask().
  virtual void hear(Peer peer, const ClockExchange& exchange) = 0;
  /// A peer has ended, or is not heard any more.
  virtual void lose(Peer peer) = 0;
  /// What a person should know.
  virtual void complain(const std::string& sentence) = 0;
};

/// The streams of a rig in a domain of DDS. Nothing waits for another computer.
class Link {
 public:
  /// What a link carries.
  struct Streams {
    bool sends_poses = false, sends_landmarks = false;
    bool takes_poses = false, takes_landmarks = false;
    bool sends_settings = false, takes_settings = false;
    bool sends_ros = false;  ///< the joints, as geometry_msgs/PoseArray of ROS 2

    /// Whether times go with what is sent and taken.
    /// @{
    bool sends() const { return sends_poses || sends_landmarks; }
    bool takes() const { return takes_poses || takes_landmarks; }
    /// @}
  };

  /// `name`: tells the others whose messages these are. Errors: bad_config (an interface or a peer
  /// is none), unavailable (DDS cannot start; the interface is not there).
  static Result<std::unique_ptr<Link>> open(const config::Bridge& settings, const Streams& streams,
                                            const std::string& name);
  virtual ~Link() = default;

  /// Sends a message to all who read its stream. One thread for each type.
  /// @{
  virtual void send(const msg::HandPoses& poses) = 0;
  virtual void send(const msg::Landmarks& landmarks) = 0;
  virtual void send(const msg::LiveSettings& settings) = 0;
  /// @}
  /// Asks every sender for its clock.
  virtual void ask() = 0;
  /// Hands on what comes until the deadline, and answers questions for our clock. One thread, that
  /// of ask().
  virtual void take(Receiver& receiver, Deadline deadline) = 0;
};

/// The settings of CycloneDDS for a link; CYCLONEDDS_URI, which is read after them, may change
/// them. Errors: bad_config (the interface or a peer has characters that no name or address has).
Result<std::string> dds_settings(const config::Bridge& settings);

}  // namespace handcast::bridge
