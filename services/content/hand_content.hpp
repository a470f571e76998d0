// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "config/sections/content.hpp"
#include "ipc/msg/content_command.hpp"
#include "ipc/msg/content_picture.hpp"
#include "ipc/ring/writer.hpp"
#include "services/content/mixer.hpp"

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
  /// @{
  void announce() { state_.trying.set(content_of_settings()); }
  void announce(const msg::ContentCommand& command) {
    if (command.is_for(like_.side)) state_.trying.set(command.content.view());
  }
  /// @}
  /// Shows the content of the settings, without a transition. What cannot be opened becomes the
  /// fault in state(), and white is shown.
  void start();
  /// Changes to the content of a command, if it is for this hand. What cannot be opened becomes the
  /// fault in state(), and the content of before goes on.
  void obey(const msg::ContentCommand& command);
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

 private:
  Result<void> change(const std::string& content, std::string_view transition, double seconds);
  const std::string& content_of_settings() const {
    return like_.side == Side::left ? settings_.left : settings_.right;
  }
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

}  // namespace handcast::content
