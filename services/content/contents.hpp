// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/live/live_board.hpp"
#include "config/rig.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/content_picture.hpp"
#include "ipc/msg/content_state.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"
#include "services/content/hands.hpp"
#include "services/content/mixer.hpp"
#include "services/runtime/live_settings.hpp"

namespace handcast::content {

/// The content of one hand: obeys commands, and publishes each picture that is new. One thread.
class HandContent {
 public:
  /// Takes the writer of its ring. Shows nothing until start(). `like`: size, side and meshes.
  HandContent(Opening like, config::Content settings, ipc::Writer<msg::ContentPicture> pictures);

  /// A content that this service died with before its first picture: start() and obey() refuse it
  /// until trust() is called.
  /// @{
  void distrust(std::string_view content) { distrusted_ = content; }
  void trust() { distrusted_.clear(); }
  /// @}
  /// Notes in state() what start() or obey() will begin.
  void announce(const std::string& content) { state_.trying.set(content); }
  /// Shows a content, without a transition. What cannot be opened becomes the fault in state(), and
  /// white is shown.
  void start(const std::string& content);
  /// Changes to the content of the settings. What cannot be opened becomes the fault in state(),
  /// and the content of before goes on.
  void obey(const config::Transition& transition);
  /// Takes other settings, whose content obey() shows. Returns whether it is another one.
  bool adjust(const config::Content& settings);
  /// Notes in state() that a change (msg::LiveSettings::header.frame_id) is done.
  void took(std::uint64_t change) { state_.command = change; }
  /// Draws the picture for a time, CLOCK_MONOTONIC, and publishes it if it is new. `camera`: see
  /// Moment.
  void draw(const HandState& hand, const HandState& other, std::int64_t time_ns,
            const CameraView* camera);

  /// What the content needs of each moment.
  Needs needs() const;
  /// True as long as a picture is due even if the hand is not there: the first one, or a change.
  bool is_due() const { return state_.pictures == 0 || mixer_.is_changing() || is_new_; }
  /// What is shown.
  const msg::ShownContent& state() const { return state_; }
  /// The name of its setting: "content.left".
  std::string_view setting() const {
    return like_.side == Side::left ? "content.left" : "content.right";
  }
  /// What the settings say.
  const std::string& content_of_settings() const {
    return like_.side == Side::left ? settings_.left : settings_.right;
  }

 private:
  Result<void> change(const std::string& content, std::string_view transition, double seconds);
  void publish(std::int64_t time_ns);
  void note_fault(const Error& error);

  Opening like_;
  config::Content settings_;
  Mixer mixer_;
  ipc::Writer<msg::ContentPicture> pictures_;
  msg::ShownContent state_;
  std::string distrusted_;
  bool is_new_ = false;  ///< a command has changed the content since the last picture
};

/// The rings of the content service.
struct Streams {
  ipc::Reader<msg::HandPoses> poses;
  ipc::Reader<msg::LiveSettings> live;
  ipc::Reader<msg::CameraFrame> images;  ///< is read only while a content needs them
  ipc::Writer<msg::ContentState> states;
  std::array<ipc::Writer<msg::ContentPicture>, 2> pictures;  ///< left, right
};

/// The contents of both hands, and what moves them. One thread.
class Contents {
 public:
  /// `filed`: the rig of the file. `calibration` outlives it. `tolerate` gets errors of the rings
  /// other than timeouts. `beat` is called after each hand, as a new content may take seconds to
  /// open and to draw first.
  Contents(Hands hands, const config::Rig& filed, const calib::Calibration& calibration,
           Streams streams, const ipc::OpenRing& ring, std::function<void(const Error&)> tolerate,
           std::function<void()> beat);

  /// Shows what was asked for last: in the file, or live. `before`: the state that a
  /// process before this one has left. What it died with is refused, and what it showed goes on.
  void start(const std::optional<msg::ContentState>& before);
  /// Waits for a change of live settings until a time, CLOCK_MONOTONIC, and obeys it. Returns
  /// whether one came. Those that a newer one follows are passed over.
  bool obey_until(std::int64_t time_ns);
  /// Draws what is due for a time, CLOCK_MONOTONIC. A hand that is not there needs no new pictures.
  void draw(std::int64_t time_ns);
  /// Tells what is shown.
  void publish_state();

 private:
  std::optional<service::LiveRig> take_change();
  void obey(const service::LiveRig& live);
  void take_poses();
  std::optional<CameraView> newest_view(bool is_needed);

  config::Rig filed_;
  Hands hands_;
  const calib::Calibration& calibration_;
  Streams streams_;
  std::function<void(const Error&)> tolerate_;
  std::function<void()> beat_;
  std::vector<HandContent> worn_;                       ///< left, right
  std::optional<ipc::Sample<msg::CameraFrame>> image_;  ///< the newest, while a content needs it
  std::uint64_t published_ = 0;
};

/// Opens both contents of the settings, but for one that is `known`: a service that is started
/// again goes on with a content whose files are gone meanwhile. Errors: bad_config, with the name
/// of the setting.
Result<void> check_contents(const Hands& hands, const config::Content& settings,
                            const calib::Calibration& calibration,
                            const std::optional<msg::ContentState>& known = {});

}  // namespace handcast::content
