// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/bridge.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/bridge/clock_map.hpp"
#include "services/bridge/gate.hpp"
#include "services/bridge/link.hpp"
#include "services/bridge/mirror.hpp"

namespace handcast::bridge {

/// The streams in the settings. Errors: bad_config (there is no such stream).
Result<Link::Streams> streams_of(const config::Bridge& settings);

/// What one turn of the bridge has brought.
struct Brought {
  std::optional<msg::HandPoses> poses;
  std::vector<std::string> settings;        ///< to be changed, for config::LiveBoard
  std::string settings_of;                  ///< who has changed them there
  std::optional<msg::Landmarks> landmarks;  ///< in pixels of the image as the lens forms it
  /// Of the newest message: how long it took, and how well its times are known.
  std::int64_t published_ns = 0, clock_error_ns = 0;
};

/// What comes from other computers, checked and by our clock. Wrong data is left out and counted; a
/// sentence says why, at most every ten seconds. One thread.
class Arrivals final : public Receiver {
 public:
  using Say = std::function<void(const std::string&)>;

  /// `lens`: of the rig's camera. `say`: takes sentences for the log.
  Arrivals(const config::Bridge& settings, const calib::CameraModel& lens, Say say);

  /// What came since the last call.
  Brought collect();
  /// When to ask for clocks again: soon while one is new.
  std::int64_t next_question_ns(std::int64_t asked_ns) const;
  /// What was left out since the start.
  std::uint64_t refused() const { return poses_.refused() + landmarks_.refused(); }

  void take(const Claim& claim, const msg::HandPoses& poses) override;
  void take(const Claim& claim, const msg::Landmarks& landmarks) override;
  void take(const Claim& claim, std::string_view values) override;
  void hear(Peer peer, const ClockExchange& exchange) override;
  void lose(Peer peer) override;
  void complain(const std::string& sentence) override;

 private:
  struct Clock {
    ClockMap map;
    int exchanges = 0;
  };
  template <class Message>
  std::optional<Message> admit(Gate& gate, const Claim& claim, const Message& message);
  void make_room();
  void tell(std::int64_t time_ns);

  calib::CameraModel lens_;
  Say say_;
  std::string from_;
  Gate poses_, landmarks_;
  Mirror mirror_;
  std::optional<Peer> mirrored_;  ///< whose settings are followed
  std::map<Peer, Clock> clocks_;
  Brought brought_;
  std::int64_t unknown_ns_ = 0;  ///< since when somebody sends whose clock is not known; 0: nobody
  std::int64_t complained_ns_ = 0, told_clock_ns_ = 0;
  std::uint64_t unsaid_ = 0;
};

}  // namespace handcast::bridge
