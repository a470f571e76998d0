// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/session.hpp"

#include <pthread.h>

#include <algorithm>
#include <utility>

#include "ipc/base/log.hpp"

namespace handcast::camera::aravis {

Image& Image::operator=(Image&& other) noexcept {
  std::swap(stream_, other.stream_);
  std::swap(buffer_, other.buffer_);
  number = other.number;
  exposed_ns = other.exposed_ns;
  exposed_error_ns = other.exposed_error_ns;
  exposure_ns = other.exposure_ns;
  lost = other.lost;
  return *this;
}

Image::~Image() {
  if (buffer_) arv_stream_push_buffer(stream_.get(), buffer_.release());
}

namespace {

/// The numbers of GigE Vision 1.x go from 1 to this and begin again at 1.
constexpr std::uint64_t kLastNumberOf16Bits = 65535;

/// 0 if `later` came before `earlier`: Aravis gives up an image with missing packets only after the
/// next one is whole.
std::uint64_t steps_between(std::uint64_t earlier, std::uint64_t later) {
  if (later > earlier && later - earlier < kLastNumberOf16Bits / 2) return later - earlier;
  const bool goes_on_at_1 = earlier > kLastNumberOf16Bits / 2 && earlier <= kLastNumberOf16Bits &&
                            later < kLastNumberOf16Bits / 2;
  return goes_on_at_1 ? later + kLastNumberOf16Bits - earlier : 0;
}

/// More images in a row than this are not late: the camera counts anew.
constexpr int kMostOlder = 4;

}  // namespace

Receiver::Receiver(const config::Camera& settings, double exposure_ms,
                   std::shared_ptr<Mailbox> mailbox)
    : priority_(settings.process.priority),
      exposure_ns_(ms_to_ns(exposure_ms)),
      delivery_ns_(ms_to_ns(settings.delivery_ms)),
      mailbox_(std::move(mailbox)) {}

/// The stream ends after its session if an image is still in use, so it owns the receiver, too.
Result<Owned<ArvStream>> Receiver::open_stream(ArvCamera* camera,
                                               const std::shared_ptr<Receiver>& receiver) {
  using Shared = std::shared_ptr<Receiver>;
  auto* shared = new Shared(receiver);
  const auto stream = ask([&](GError** error) {
    return arv_camera_create_stream_full(
        camera, on_stream, shared, [](void* gone) { delete static_cast<Shared*>(gone); }, error);
  });
  if (!stream) return tl::make_unexpected(stream.error());
  const std::scoped_lock lock(receiver->mutex_);
  receiver->stream_ = *stream;
  return Owned<ArvStream>(*stream);
}

void Receiver::close() {
  const std::scoped_lock lock(mutex_);
  stream_ = nullptr;
  mailbox_->clear();
  mailbox_.reset();  // its owner may own this stream by an image
}

void Receiver::on_stream(void* receiver, ArvStreamCallbackType what, ArvBuffer*) {
  auto& self = **static_cast<std::shared_ptr<Receiver>*>(receiver);
  if (what == ARV_STREAM_CALLBACK_TYPE_INIT) self.begin_thread();
  if (what == ARV_STREAM_CALLBACK_TYPE_BUFFER_DONE) self.on_buffer_done(now_ns());
}

void Receiver::begin_thread() const {
  pthread_setname_np(pthread_self(), "camera-stream");
  if (priority_ > 0 && !arv_make_thread_realtime(priority_))
    log::warning("the thread that receives the images has no real-time priority");
}

void Receiver::on_buffer_done(std::int64_t arrived_ns) {
  const std::scoped_lock lock(mutex_);
  if (!stream_) return;
  Owned<ArvBuffer> buffer(arv_stream_try_pop_buffer(stream_));
  if (!buffer) return;
  const std::uint64_t steps = steps_to(arv_buffer_get_frame_id(buffer.get()));
  if (steps == 0)  // it has been counted as missing
    return arv_stream_push_buffer(stream_, buffer.release());
  auto lost = lost_in(steps);
  if (arv_buffer_get_status(buffer.get()) != ARV_BUFFER_STATUS_SUCCESS) {
    ++lost.incomplete;
    mailbox_->count(lost, steps);
    return arv_stream_push_buffer(stream_, buffer.release());
  }
  auto image = image_of(std::move(buffer), arrived_ns);
  image.lost = lost;
  mailbox_->put(image, steps);
}

/// Earliest arrival = end of the exposure + delivery, whatever moment the camera's stamp means: the
/// map has learned the rest.
Image Receiver::image_of(Owned<ArvBuffer> buffer, std::int64_t arrived_ns) {
  const auto stamp_ns = static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer.get()));
  clock_.add(stamp_ns, arrived_ns);
  const auto arrival = clock_.earliest_arrival(stamp_ns);
  Image image(Owned<ArvStream>(ARV_STREAM(g_object_ref(stream_))), std::move(buffer));
  image.exposure_ns = exposure_ns_;
  image.exposed_ns = std::min(arrival.ns, arrived_ns) - delivery_ns_ - image.exposure_ns / 2;
  image.exposed_error_ns = arrival.error_ns;
  return image;
}

std::uint64_t Receiver::steps_to(std::uint64_t camera_number) {
  std::uint64_t steps = camera_number_ ? steps_between(*camera_number_, camera_number) : 1;
  older_in_a_row_ = steps == 0 ? older_in_a_row_ + 1 : 0;
  if (older_in_a_row_ > kMostOlder) steps = 1;
  if (steps > 0) camera_number_ = camera_number;
  return steps;
}

msg::FrameLosses Receiver::lost_in(std::uint64_t steps) {
  guint64 completed = 0, failed = 0, underruns = 0;
  arv_stream_get_statistics(stream_, &completed, &failed, &underruns);
  const auto before = std::exchange(underruns_, underruns);
  msg::FrameLosses lost;
  lost.underrun = static_cast<std::uint32_t>(std::min(underruns - before, steps - 1));
  lost.missing = static_cast<std::uint32_t>(steps - 1 - lost.underrun);
  return lost;
}

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
