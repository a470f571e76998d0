// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "services/camera/camera.hpp"
#include "services/camera/keep/silence.hpp"
#include "services/camera/keep/trouble.hpp"
#include "services/camera/leap/bring_up.hpp"
#include "services/camera/leap/deinterleave.hpp"
#include "services/camera/leap/session.hpp"

namespace handcast::camera::leap {
namespace {

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

constexpr std::int64_t kAbsent_ns = 20'000'000;

Keeper::Keeper(const config::Camera& settings, const calib::PlacedCamera& camera,
               std::unique_ptr<Session> session, std::shared_ptr<Mailbox> mailbox)
    : settings_(settings),
      camera_(camera),
      session_(std::move(session)),
      mailbox_(std::move(mailbox)),
      name_(session_->name()),
      silence_(Silence::patience_of(session_->mode().rate_hz)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Keeper::~Keeper() {
  thread_.request_stop();
  thread_.join();
}

void Keeper::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (session_)
      watch();
    else
      reopen();
  }
}

void Keeper::watch() {
  sleep_until_ns(now_ns() + Silence::kTurn_ns);
  const std::int64_t last_ns = mailbox_->last_sign_ns();
  const bool has_come = silence_.is_broken(last_ns);
  if (has_come && trouble()) {
    log::info("{} is back after {:.0f} ms", name_, ns_to_ms(now_ns() - lost_ns_));
    trouble_.end();
  }
  const auto ended = session_->trouble();
  if (!ended && !silence_.is_too_long(last_ns, now_ns())) return;
  vain_starts_ = has_come ? 0 : vain_starts_ + 1;
  if (has_come) lost_ns_ = now_ns();
  if (ended)
    trouble_.say(
        {ended->code, fmt::format("{}; it is opened again as soon as it answers", ended->what)});
  else if (has_come)
    trouble_.say({Errc::timeout, fmt::format("{} sends no images; it is opened again", name_)});
  else
    trouble_.say(
        {Errc::timeout,
         fmt::format("{} answers, but sends no images; firmware before 1.7.1 needs a longer "
                     "bring-up sequence (leap.bring_up)",
                     name_)});
  session_.reset();
}

void Keeper::reopen() {
  // The one that was lost, even if another one is attached meanwhile.
  auto session = Session::start(name_, settings_, camera_, mailbox_, vain_starts_ > 0);
  if (!session) {
    trouble_.say(
        {session.error().code, fmt::format("{}: {}; it is opened again as soon as it answers",
                                           name_, session.error().what)});
    return sleep_until_ns(now_ns() + kAbsent_ns);
  }
  session_ = std::move(*session);
  silence_.begin_again();
}

}  // namespace

}  // namespace handcast::camera::leap

namespace handcast::camera {
namespace {

/// A Leap Motion Controller as a stereo camera.
class LeapCamera final : public Camera {
 public:
  LeapCamera(const config::Camera& settings, const calib::PlacedCamera& camera,
             std::unique_ptr<leap::Session> session, std::shared_ptr<leap::Mailbox> mailbox)
      : eye_(settings.leap.eye == config::Eye::left ? 0 : 1),
        width_px_(camera.model.width_px),
        height_px_(camera.model.height_px),
        exposure_ns_(ms_to_ns(settings.exposure_ms)),
        mailbox_(mailbox),
        keeper_(settings, camera, std::move(session), std::move(mailbox)) {}

  bool has_second_image() const override { return true; }

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    if (auto taken = take(tail_bytes, deadline); !taken) return taken;
    write(eye_, frame);
    return {};
  }

  Result<void> capture_both(msg::CameraFrame& frame, msg::CameraFrame& second,
                            std::size_t tail_bytes, Deadline deadline) override {
    if (auto taken = take(tail_bytes, deadline); !taken) return taken;
    write(eye_, frame);
    write(1 - eye_, second);
    return {};
  }

 private:
  Result<void> take(std::size_t tail_bytes, Deadline deadline) {
    if (auto room = check_room(width_px_, height_px_, tail_bytes); !room) return room;
    if (mailbox_->take(image_, deadline)) return {};
    if (const auto trouble = keeper_.trouble()) return tl::make_unexpected(*trouble);
    return fail(Errc::timeout, "no image before the deadline");
  }

  void write(std::size_t eye, msg::CameraFrame& frame) const {
    frame.header.frame_id = image_.number;
    frame.header.origin_ns = image_.exposed_ns;
    frame.exposure_ns = exposure_ns_;
    frame.origin_error_ns = image_.exposed_error_ns;
    frame.lost = image_.lost;
    frame.width_px = static_cast<std::uint32_t>(width_px_);
    frame.height_px = static_cast<std::uint32_t>(height_px_);
    const auto pixels = static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
    leap::deinterleave(image_.bytes, eye, width_px_, {frame.pixels(), pixels});
  }

  std::size_t eye_;  ///< whose images go to the first message: 0 left, 1 right
  int width_px_, height_px_;
  std::int64_t exposure_ns_;
  leap::StereoImage image_;
  std::shared_ptr<leap::Mailbox> mailbox_;
  leap::Keeper keeper_;
};

void report(const leap::Session& session, double asked_hz) {
  const auto& mode = session.mode();
  const auto text =
      fmt::format("{} sends {}x{} of both eyes", session.name(), mode.width_px, mode.height_px);
  if (std::abs(mode.rate_hz - asked_hz) < 0.01 * asked_hz)
    return log::info("{} at {:.4g} Hz", text, mode.rate_hz);
  log::warning("{} at {:.4g} Hz instead of {:g} Hz (rate_hz)", text, mode.rate_hz, asked_hz);
}

}  // namespace

Result<std::unique_ptr<Camera>> open_leap(const Opening& with) {
  const auto& settings = with.settings;
  // Numbers go on over restarts of the service; the rate is at most 250 Hz.
  constexpr std::int64_t kShortestPeriod_ns = 4'000'000;
  const auto first = static_cast<std::uint64_t>(
      std::max<std::int64_t>(now_ns() - with.epoch_ns, 0) / kShortestPeriod_ns);
  const auto mailbox = std::make_shared<leap::Mailbox>(first);
  auto session = leap::Session::start(settings.leap.device, settings, with.camera, mailbox, false);
  if (!session) return tl::make_unexpected(session.error());
  report(**session, settings.rate_hz);
  return std::make_unique<LeapCamera>(settings, with.camera, std::move(*session), mailbox);
}

Result<void> check_leap(const Opening& with) {
  const auto steps = leap::load_bring_up(with.settings.leap.bring_up);
  if (!steps) return fail_in("leap.bring_up", steps.error());
  return {};
}

}  // namespace handcast::camera
