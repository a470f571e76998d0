// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/session.hpp"

#include <utility>

namespace handcast::camera::aravis {
namespace {

/// Enough for 30 ms of a 525 Hz camera while this process does not run.
constexpr int kBuffers = 16;
/// Images that the kernel keeps while the thread of the stream does not run; net.core.rmem_max
/// limits it.
constexpr int kSocketImages = 8;

}  // namespace

Session::Session(Owned<ArvCamera> camera, Device device, const config::Camera& settings,
                 std::shared_ptr<Mailbox> mailbox)
    : camera_(std::move(camera)),
      device_(std::move(device)),
      settings_(settings),
      mailbox_(std::move(mailbox)) {}

Result<std::unique_ptr<Session>> Session::start(const Device& device,
                                                const config::Camera& settings,
                                                const calib::PlacedCamera& camera,
                                                std::shared_ptr<Mailbox> mailbox) {
  auto opened = open_device(device);
  if (!opened) return tl::make_unexpected(opened.error());
  const auto named = with_its_names(opened->get(), device);
  const auto [serial, id, address, model] = names_of(named);
  if (auto ours = calib::check_device("camera", camera.device, {serial, id, address, model}); !ours)
    return tl::make_unexpected(ours.error());
  std::unique_ptr<Session> session(
      new Session(std::move(*opened), named, settings, std::move(mailbox)));
  const auto accepted =
      configure(session->camera_.get(), settings, camera.model.width_px, camera.model.height_px);
  if (!accepted) return tl::make_unexpected(accepted.error());
  session->accepted_ = *accepted;
  if (const auto started = session->start_stream(); !started)
    return tl::make_unexpected(started.error());
  return session;
}

Result<void> Session::start_stream() {
  const auto payload =
      ask([&](GError** error) { return arv_camera_get_payload(camera_.get(), error); });
  if (!payload) return tl::make_unexpected(payload.error());
  receiver_ = std::make_shared<Receiver>(settings_, accepted_.exposure_ms, mailbox_);
  auto stream = Receiver::open_stream(camera_.get(), receiver_);
  if (!stream) return tl::make_unexpected(stream.error());
  stream_ = std::move(*stream);
  if (arv_camera_is_gv_device(camera_.get()))
    g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED,
                 "socket-buffer-size", static_cast<int>(kSocketImages * *payload), nullptr);
  for (int i = 0; i < kBuffers; ++i)
    arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(*payload));
  return ask([&](GError** error) { arv_camera_start_acquisition(camera_.get(), error); });
}

Session::~Session() {
  if (!stream_) return;
  receiver_->close();
  (void)ask([&](GError** error) { arv_camera_stop_acquisition(camera_.get(), error); });
}

Result<void> Session::trigger() {
  return ask([&](GError** error) { arv_camera_software_trigger(camera_.get(), error); });
}

}  // namespace handcast::camera::aravis
