// SPDX-License-Identifier: Apache-2.0
#include "supervisor/spec/service_spec.hpp"

#include "config/guests.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/content_picture.hpp"
#include "ipc/msg/content_state.hpp"
#include "ipc/msg/guest_picture.hpp"
#include "ipc/msg/guest_streams.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/largest_images.hpp"
#include "ipc/msg/live_settings.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/msg/test_picture.hpp"
#include "supervisor/spec/fingerprint.hpp"

namespace handcast::supervisor {
namespace {

/// The most slots that a ring can have: the recorder may be 0.25 s late at 946 Hz.
constexpr int kMarkSlots = 254;
/// Three readers with two leases each, and two for the writer: a loan never fails. A fourth
/// (camera2, projector2) has a lease for as long as it copies.
constexpr int kImageSlots = 8;
/// Two readers with two leases each, and two for the writer.
constexpr int kPictureSlots = 6;

/// The newest, the one that is written, and one to write meanwhile: its reader takes no lease.
constexpr int kGuestSlots = 3;
/// A program that sends 2000 samples a second overwrites none within 8 ms.
constexpr int kGuestHistory = 16;

constexpr bool kNewestOnly = false, kWithHistory = true;

ipc::RingSpec guest_ring(const char* stream) {
  constexpr auto kLargest_px = msg::GuestPicture::kLargest_px;
  return ipc::RingSpec::of<msg::GuestPicture>(stream, kGuestSlots, kNewestOnly,
                                              msg::GuestPicture::bytes(kLargest_px, kLargest_px));
}

ipc::RingSpec images(std::string_view stream, int slots) {
  return ipc::RingSpec::of<msg::CameraFrame>(
      std::string(stream), slots, kNewestOnly,
      msg::CameraFrame::bytes(msg::kLargestCameraWidth_px, msg::kLargestCameraHeight_px));
}

ipc::RingSpec projections(const char* stream) {
  return ipc::RingSpec::of<msg::Projection>(
      stream, kImageSlots, kNewestOnly,
      msg::Projection::bytes(msg::kLargestProjectorWidth_px, msg::kLargestProjectorHeight_px));
}

std::vector<ipc::RingSpec> all_streams() {
  using ipc::RingSpec;
  return {
      images("camera.frames", kImageSlots),
      images("camera2.frames", kImageSlots),
      RingSpec::of<msg::HandPoses>("pose.hands", 64, kWithHistory),
      RingSpec::of<msg::Landmarks>("landmarks.hands", 32, kWithHistory),
      RingSpec::of<msg::Landmarks>("landmarks2.hands", 32, kWithHistory),
      projections("projection.frames"),
      projections("projection2.frames"),
      RingSpec::of<msg::TestPicture>(std::string(msg::kTestPictures), kPictureSlots, kNewestOnly,
                                     msg::TestPicture::bytes(msg::kLargestTestPictureWidth_px,
                                                             msg::kLargestTestPictureHeight_px)),
      RingSpec::of<msg::LiveSettings>(std::string(msg::kLiveSettings), 8, kNewestOnly),
      guest_ring("guest.left"),
      guest_ring("guest.right"),
      images(msg::kGuestImages, kPictureSlots),
      images(msg::kSecondGuestImages, kPictureSlots),
      RingSpec::of<msg::HandPoses>(std::string(msg::kGuestPoses), kGuestHistory, kWithHistory),
      RingSpec::of<msg::Landmarks>(std::string(msg::kGuestLandmarks), kGuestHistory, kWithHistory),
      RingSpec::of<msg::Landmarks>(std::string(msg::kSecondGuestLandmarks), kGuestHistory,
                                   kWithHistory),
  };
}

/// The rings of the content service, for pictures of the size in the settings.
std::vector<ipc::RingSpec> content_streams(std::size_t picture_bytes) {
  using ipc::RingSpec;
  return {
      RingSpec::of<msg::ContentPicture>("content.left", kPictureSlots, kNewestOnly, picture_bytes),
      RingSpec::of<msg::ContentPicture>("content.right", kPictureSlots, kNewestOnly, picture_bytes),
      RingSpec::of<msg::ContentState>("content.state", 8, kNewestOnly),
  };
}

/// The services of a second camera. One that delivers the images of both ("leap") is one service,
/// which needs no second one.
void add_second_view(const config::Rig& rig, std::vector<ServiceSpec>& services) {
  const bool has_camera = rig.camera2.backend != "none";
  if (has_camera)
    services.push_back({.name = "camera2",
                        .stream = "camera2.frames",
                        .backend = rig.camera2.backend,
                        .wanted_hz = rig.camera2.rate_hz,
                        .instance_of = "camera"});
  if (has_camera || rig.pose.backend == "stereo" || rig.pose.second == "stereo")
    services.push_back({.name = "landmarks2",
                        .stream = "landmarks2.hands",
                        .backend = rig.landmarks2.backend,
                        .needs = {has_camera ? "camera2" : "camera"},
                        .instance_of = "landmarks"});
}

/// A second projector, which lights the same hands.
void add_second_projector(const config::Rig& rig, std::vector<ServiceSpec>& services) {
  const auto& second = rig.projector2;
  if (second.backend == "none") return;
  services.push_back({.name = "projector2",
                      .stream = "projection2.frames",
                      .backend = second.backend,
                      .wanted_hz = second.rate_hz,
                      .needs = {"camera", "pose", "landmarks"},
                      .counts_sub_frames = second.packing != config::Packing::none,
                      .instance_of = "projector"});
}

/// The programs of other people, after the services that they feed.
void add_guests(const config::Rig& rig, std::vector<ServiceSpec>& services) {
  constexpr double kSlack_s = 5;  // a guest ends itself before
  for (const auto& guest : config::kGuests)
    if (guest.is_wanted(rig))
      services.push_back({.name = std::string(guest.service),
                          .needs = {std::string(guest.feeds)},
                          .instance_of = "guest",
                          .ready_s = config::first_message_within_s(guest.settings(rig)) + kSlack_s,
                          .shows_log = true});
}

/// Whether the desk has anything to serve.
bool has_surface(const config::Desk& desk) {
  return !desk.page.listen.empty() || !desk.osc.listen.empty() || !desk.osc.send.empty() ||
         !desk.midi.device.empty() || !desk.cues.empty();
}

ipc::RingSpec marks_of(const ServiceSpec& service) {
  return ipc::RingSpec::of<msg::StageMarks>(daemon::marks_stream_of(service.name), kMarkSlots,
                                            kWithHistory);
}

}  // namespace

std::vector<std::string> command_of(const ServiceSpec& service,
                                    const std::filesystem::path& program_folder) {
  if (service.instance_of.empty()) return {program_folder / ("handcast-" + service.name)};
  return {program_folder / ("handcast-" + service.instance_of), "--as", service.name};
}

std::vector<ServiceSpec> services_of(const config::Rig& rig, const Catalogue& catalogue) {
  std::vector<ServiceSpec> services{
      {"camera", "camera.frames", rig.camera.backend, rig.camera.rate_hz},
      {"pose", "pose.hands", rig.pose.backend, rig.twin.tracker.rate_hz, "twin"},
      {"landmarks", "landmarks.hands", rig.landmarks.backend, 0, "", {"camera"}},
  };
  add_second_view(rig, services);
  services.push_back({"projector",
                      "projection.frames",
                      rig.projector.backend,
                      rig.projector.rate_hz,
                      "",
                      {"camera", "pose", "landmarks"}});
  services.back().counts_sub_frames = rig.projector.packing != config::Packing::none;
  add_second_projector(rig, services);
  services.push_back({"content", "content.left", "", 0});
  services.back().message_bytes =
      msg::ContentPicture::bytes(rig.content.width_px, rig.content.height_px);
  if (has_surface(rig.desk)) services.push_back({"desk", "", "", 0});
  if (rig.dlp.backend != "none") {
    services.push_back({"dlp", "", rig.dlp.backend, 0});
    services.back().has_safe_state = true;
  }
  if (rig.observer.enabled)
    services.push_back({"observer", "", "", rig.observer.rate_hz, "", {"projector"}});
  if (rig.watch.enabled) services.push_back({"watch", "", "", 0});
  if (rig.bridge.is_wanted()) services.push_back({.name = "bridge", .shows_log = true});
  if (rig.supervisor.metrics_port > 0) services.push_back({"exporter", "", "", 0});
  add_guests(rig, services);
  for (auto& service : services) {
    if (service.name == "landmarks") service.fallback = rig.landmarks.fallback;
    if (service.name == "landmarks2") service.fallback = rig.landmarks2.fallback;
    service.process = config::process_of(rig, service.name);
    if (service.instance_of == "guest") service.process.standby = false;  // one program sends
    service.fingerprint = fingerprint_of(service.name, rig, catalogue);
  }
  return services;
}

std::vector<ipc::RingSpec> rings_of(const std::vector<ServiceSpec>& services) {
  std::vector<ipc::RingSpec> rings = all_streams();
  for (const auto& service : services) {
    rings.push_back(marks_of(service));
    if (service.name == "content")
      for (auto& ring : content_streams(service.message_bytes)) rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace handcast::supervisor
