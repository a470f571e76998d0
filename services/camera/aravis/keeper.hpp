// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string_view>
#include <thread>

#include "services/camera/aravis/session.hpp"
#include "services/camera/keep/silence.hpp"
#include "services/camera/keep/trouble.hpp"

namespace handcast::camera::aravis {

/// Keeps a camera streaming: sees within about 50 ms that its images have stopped, looks for the
/// camera, and opens it anew once it answers, on a thread of its own, because a device that is
/// absent blocks calls for seconds. Also gives the software triggers.
class Keeper {
 public:
  /// `session` streams into `mailbox`. `device`: where to look for it when it is lost.
  Keeper(Device device, const config::Camera& settings, const calib::PlacedCamera& camera,
         std::unique_ptr<Session> session, std::shared_ptr<Mailbox> mailbox);
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;
  ~Keeper();

  /// Why no images come now; empty if they should come. Any thread.
  std::optional<Error> trouble() const { return trouble_.why(); }

 private:
  void run(const std::stop_token& stop);
  void watch();
  void look_for_it();
  /// Says that the camera is lost, if it has not been said. `answers`: it is there, and only its
  /// images are not.
  void miss_it(bool answers);
  Error why_no_images(bool answers) const;
  /// Opens the camera anew, unless its images have come back by themselves.
  void reopen();
  /// Its images have come.
  void found(std::string_view how);

  Device device_;
  config::Camera settings_;
  calib::PlacedCamera camera_;
  std::unique_ptr<Session> session_;
  std::shared_ptr<Mailbox> mailbox_;
  Presence presence_;
  Silence silence_;
  std::int64_t next_trigger_ns_;  ///< of the software triggers
  bool is_lost_ = false;
  bool is_reopened_ = false;  ///< and has not yet sent an image
  std::int64_t lost_ns_ = 0;  ///< when it was lost
  Trouble trouble_;
  std::jthread thread_;
};

}  // namespace handcast::camera::aravis
