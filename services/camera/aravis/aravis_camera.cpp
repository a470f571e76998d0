// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "services/camera/aravis/device.hpp"
#include "services/camera/aravis/pixels.hpp"
#include "services/camera/aravis/session.hpp"
#include "services/camera/camera.hpp"
#include "services/camera/keep/silence.hpp"
#include "services/camera/keep/trouble.hpp"

namespace handcast::camera::aravis {
namespace {

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

/// An external trigger may pause for any time: only Aravis can tell that the camera is lost.
std::int64_t patience_of(const config::Camera& settings) {
  if (settings.aravis.trigger == config::Trigger::line) return seconds_to_ns(6);
  return Silence::patience_of(settings.rate_hz);
}

Keeper::Keeper(Device device, const config::Camera& settings, const calib::PlacedCamera& camera,
               std::unique_ptr<Session> session, std::shared_ptr<Mailbox> mailbox)
    : device_(std::move(device)),
      settings_(settings),
      camera_(camera),
      session_(std::move(session)),
      mailbox_(std::move(mailbox)),
      presence_(device_),
      silence_(patience_of(settings)),
      next_trigger_ns_(now_ns()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Keeper::~Keeper() {
  thread_.request_stop();
  thread_.join();
  // Taking leave of an absent camera takes seconds, which nobody has to wait for.
  if (is_lost_) std::thread([session = std::move(session_)] {}).detach();
}

void Keeper::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (is_lost_)
      look_for_it();
    else
      watch();
  }
}

void Keeper::watch() {
  if (settings_.aravis.trigger == config::Trigger::software) {
    // Triggers that came too late are not made up for.
    next_trigger_ns_ = std::max(next_trigger_ns_ + seconds_to_ns(1 / settings_.rate_hz), now_ns());
    sleep_until_ns(next_trigger_ns_);
    (void)session_->trigger();  // if it fails, no image comes, which is seen below
  } else {
    sleep_until_ns(now_ns() + Silence::kTurn_ns);
  }
  const std::int64_t last_ns = mailbox_->last_sign_ns();
  if (is_reopened_ && silence_.is_broken(last_ns)) found("it was opened again");
  if (!silence_.is_too_long(last_ns, now_ns())) return;
  is_lost_ = true;
  if (!is_reopened_) lost_ns_ = now_ns();
}

Error Keeper::why_no_images(bool answers) const {
  if (!answers || silence_.is_broken(mailbox_->last_sign_ns()))
    return {Errc::timeout, fmt::format("{} sends no images; it is opened again as "
                                       "soon as it answers",
                                       device_.id)};
  if (!device_.is_gige() || !session_)
    return {Errc::timeout, fmt::format("{} answers, but none of its images arrives", device_.id)};
  return {Errc::timeout,
          fmt::format("{} answers, but none of its images arrives; packets of {} "
                      "bytes may be too large for the network (aravis.packet_bytes; 1500 "
                      "pass nearly everywhere), or a firewall stops them",
                      device_.id, session_->accepted().packet_bytes)};
}

void Keeper::miss_it(bool answers) {
  const auto why = why_no_images(answers);
  // That it answers is known later than that it is silent.
  if (const auto said = trouble(); said && (!answers || !session_ || said->what == why.what))
    return;
  trouble_.say(why);
}

void Keeper::look_for_it() {
  if (presence_.is_there()) return reopen();
  if (mailbox_->last_sign_ns() > lost_ns_) return found("its images came back");
  miss_it(false);
  sleep_until_ns(now_ns() + Silence::kTurn_ns);
}

void Keeper::reopen() {
  const std::int64_t answered_ns = now_ns();
  // After a cable was plugged in again, the images come back by themselves.
  sleep_until_ns(answered_ns +
                 std::max(2 * Silence::kTurn_ns, seconds_to_ns(3 / settings_.rate_hz)));
  if (mailbox_->last_sign_ns() > answered_ns) return found("its images came back");
  miss_it(true);
  session_.reset();
  auto session = Session::start(device_, settings_, camera_, mailbox_);
  if (!session) {
    trouble_.say(session.error());
    return sleep_until_ns(now_ns() + Silence::kTurn_ns);
  }
  session_ = std::move(*session);
  silence_.begin_again();
  next_trigger_ns_ = now_ns();
  is_lost_ = false;
  is_reopened_ = true;
}

void Keeper::found(std::string_view how) {
  if (trouble())
    log::info("{} is back after {:.0f} ms: {}", device_.id, ns_to_ms(now_ns() - lost_ns_), how);
  is_lost_ = is_reopened_ = false;
  trouble_.end();
}

}  // namespace

}  // namespace handcast::camera::aravis

namespace handcast::camera {
namespace {

/// A GigE Vision or USB3 Vision camera. The images are copied into the slots of the ring: Aravis
/// wants the memory of an image before it begins, and which slot will be free then is not known
/// (DECISIONS.md).
class AravisCamera final : public Camera {
 public:
  AravisCamera(const aravis::Device& device, const config::Camera& settings,
               const calib::PlacedCamera& camera, std::unique_ptr<aravis::Session> session,
               std::shared_ptr<aravis::Mailbox> mailbox)
      : format_(settings.aravis.format),
        width_px_(camera.model.width_px),
        height_px_(camera.model.height_px),
        mailbox_(mailbox),
        keeper_(device, settings, camera, std::move(session), std::move(mailbox)) {}

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    if (auto room = check_room(width_px_, height_px_, tail_bytes); !room) return room;
    aravis::Image image;
    if (mailbox_->take(image, deadline)) return copy(image, frame);
    if (const auto trouble = keeper_.trouble()) return tl::make_unexpected(*trouble);
    return fail(Errc::timeout, "no image before the deadline");
  }

 private:
  Result<void> copy(const aravis::Image& image, msg::CameraFrame& frame) const {
    const auto pixels = static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
    std::size_t bytes = 0;
    const void* data = arv_buffer_get_data(image.buffer(), &bytes);
    if (!data || bytes < bytes_of(format_, pixels))
      return fail(Errc::bad_data, fmt::format("an image of {} bytes instead of {}", bytes,
                                              bytes_of(format_, pixels)));
    frame.header.frame_id = image.number;
    frame.header.origin_ns = image.exposed_ns;
    frame.exposure_ns = image.exposure_ns;
    frame.origin_error_ns = image.exposed_error_ns;
    frame.lost = image.lost;
    frame.width_px = static_cast<std::uint32_t>(width_px_);
    frame.height_px = static_cast<std::uint32_t>(height_px_);
    to_grey(format_, {static_cast<const std::uint8_t*>(data), bytes}, {frame.pixels(), pixels});
    return {};
  }

  config::PixelFormat format_;
  int width_px_, height_px_;
  std::shared_ptr<aravis::Mailbox> mailbox_;
  aravis::Keeper keeper_;
};

Result<std::unique_ptr<Camera>> open_camera(const Opening& with) {
  const auto device = aravis::find_device(with.settings.aravis.device);
  if (!device) return tl::make_unexpected(device.error());
  const auto mailbox = std::make_shared<aravis::Mailbox>(1);
  auto session = aravis::Session::start(*device, with.settings, with.camera, mailbox);
  if (!session) return tl::make_unexpected(session.error());
  const auto& named = (*session)->device();
  const auto& accepted = (*session)->accepted();
  log::info(
      "{} {} {}, {:.1f} Hz, exposure {:.3f} ms{}", named.vendor, named.model, named.serial,
      accepted.rate_hz, accepted.exposure_ms,
      accepted.packet_bytes > 0 ? fmt::format(", packets of {} bytes", accepted.packet_bytes) : "");
  return std::make_unique<AravisCamera>(*device, with.settings, with.camera, std::move(*session),
                                        mailbox);
}

}  // namespace

// The table has the rest of its row.
const service::LoadedBackEnd<CameraBackend> handcast_camera_back_end{
    .row = {.name = "aravis", .open = open_camera, .attached = aravis::attached}};

}  // namespace handcast::camera
