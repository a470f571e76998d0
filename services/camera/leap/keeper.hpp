// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "services/camera/keep/silence.hpp"
#include "services/camera/keep/trouble.hpp"
#include "services/camera/leap/session.hpp"

namespace handcast::camera::leap {

/// Keeps a controller streaming: sees within about 50 ms that its images have stopped, and opens it
/// again as soon as it answers, on a thread of its own, because a device that is stuck blocks calls
/// for half a second.
class Keeper {
 public:
  /// `session` streams into `mailbox`.
  Keeper(const config::Camera& settings, const calib::PlacedCamera& camera,
         std::unique_ptr<Session> session, std::shared_ptr<Mailbox> mailbox);
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;
  ~Keeper();

  /// Why no images come now; empty if they should come. Any thread.
  std::optional<Error> trouble() const { return trouble_.why(); }

 private:
  void run(const std::stop_token& stop);
  void watch();
  void reopen();

  config::Camera settings_;
  calib::PlacedCamera camera_;
  std::unique_ptr<Session> session_;
  std::shared_ptr<Mailbox> mailbox_;
  std::string name_;  ///< of the controller
  Silence silence_;
  std::int64_t lost_ns_ = 0;  ///< when its images stopped
  int vain_starts_ = 0;       ///< sessions in a row without an image
  Trouble trouble_;
  std::jthread thread_;
};

}  // namespace handcast::camera::leap
