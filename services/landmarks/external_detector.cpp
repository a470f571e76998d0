// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <utility>

#include "services/landmarks/detector.hpp"
#include "services/runtime/guest_stream.hpp"

namespace handcast::landmarks {
namespace {

/// The landmarks of a program that is not part of the rig (ipc/client/handcast.h), in pixels of the
/// image as the lens forms it. The program reads the images itself and decides which of them it
/// searches. The first image has no hand if no program sends yet, so that the rig need not wait for
/// one.
class ExternalDetector final : public Detector {
 public:
  ExternalDetector(service::GuestStream<msg::Landmarks> guests, const calib::CameraModel& lens)
      : guests_(std::move(guests)), lens_(lens) {}

  Result<msg::Landmarks> detect(const msg::CameraFrame& frame, const Hints&,
                                Deadline deadline) override {
    const auto sent = guests_.latest(deadline);
    if (const bool is_first = std::exchange(is_first_, false); !sent) {
      if (!is_first || sent.error().code != Errc::timeout) return tl::make_unexpected(sent.error());
      return msg::Landmarks{.header = {frame.header.frame_id, frame.header.origin_ns, 0}};
    }
    msg::Landmarks found = **sent;
    for (auto& hand : std::span(found.hands).first(found.count))
      for (auto& point : hand.points) {
        const auto straight = lens_.undistort({point.x_px, point.y_px});
        point.x_px = static_cast<float>(straight.x);
        point.y_px = static_cast<float>(straight.y);
      }
    return found;
  }

  bool reads_images() const override { return false; }

 private:
  service::GuestStream<msg::Landmarks> guests_;
  calib::CameraModel lens_;
  bool is_first_ = true;
};

}  // namespace

Result<std::unique_ptr<Detector>> open_external(const Opening& with) {
  auto guests = service::GuestStream<msg::Landmarks>::open(
      with.ring, "guest." + config::name_at(with.at, "landmarks"), with.settings.process.wait);
  if (!guests) return tl::make_unexpected(guests.error());
  return std::make_unique<ExternalDetector>(std::move(*guests), with.camera.model);
}

}  // namespace handcast::landmarks
