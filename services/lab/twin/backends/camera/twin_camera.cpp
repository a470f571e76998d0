// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "calib/solve/board/board_name.hpp"
#include "calib/solve/board/draw_board.hpp"
#include "services/camera/camera.hpp"
#include "services/lab/twin/backends/camera/seen_light.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/runtime/first_at.hpp"

namespace handcast::camera {
namespace {

/// The upper limit of the estimated drawing time. Without it, one image that took a second would
/// make all later ones seem too late to be drawn.
constexpr std::int64_t kLongestDrawing_ns = 20'000'000;

/// The picture on a board, as it is printed.
Result<twin::FlatPicture> picture_of(const std::string& board_name) {
  constexpr int kSquare_px = 40;
  constexpr std::uint8_t kBlackInk = 20;  // of 255: its reflectance
  const auto board = calib::parse_board(board_name);
  if (!board) return tl::make_unexpected(board.error());
  auto drawn = calib::draw_board(*board, kSquare_px);
  twin::FlatPicture picture;
  picture.width_px = drawn.width_px;
  picture.height_px = drawn.height_px;
  picture.pixels = std::move(drawn.pixels);
  for (auto& pixel : picture.pixels) pixel = std::max(pixel, kBlackInk);
  picture.metres_per_px = 1e-3 * board->square_mm / kSquare_px;
  picture.origin_px = glm::dvec2(kSquare_px / 2.0 - 0.5);
  return picture;
}

/// The twin's camera in real time. An image depends only on its number, so it is drawn before its
/// arrival and delivered on time. A slow machine delivers fewer images, not late ones. Only images
/// of the projector's light come late: they are drawn after their exposure, when all of its light
/// is known. Their stamps are true.
class TwinCamera final : public Camera {
 public:
  TwinCamera(std::unique_ptr<twin::Twin> twin, const config::Camera& settings,
             const calib::CameraModel& model, std::int64_t epoch_ns)
      : twin_(std::move(twin)),
        model_(model),
        exposure_ns_(ms_to_ns(settings.exposure_ms)),
        epoch_ns_(epoch_ns) {}

  bool sees_light() const override { return light_.has_value(); }
  void watch_light(ipc::Reader<msg::Projection> projections) override {
    projections_ = std::move(projections);
  }
  bool is_adjustable() const override { return true; }
  void adjust(const config::Rig& rig) override { twin_->adjust(rig.twin); }

  /// Shows a board in place of hands, in the light of the projector.
  Result<void> show_board(const config::TwinProp& settings, const config::Projector& projector) {
    auto picture = picture_of(settings.board);
    if (!picture) return tl::make_unexpected(picture.error());
    light_.emplace(ms_to_ns(settings.light_late_ms), seconds_to_ns(1 / projector.rate_hz),
                   true_light(projector, settings.light_gamma));
    early_ns_ = std::max<std::int64_t>(0, -ms_to_ns(settings.light_late_ms));
    return twin_->show_board(*picture);
  }

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    if (auto room = check_room(model_.width_px, model_.height_px, tail_bytes); !room) return room;
    const auto arrival_ns = [&](std::uint64_t k) {
      return epoch_ns_ + twin_->camera_arrival_ns(k);
    };
    std::uint64_t k = timing::first_at(next_, now_ns() + drawing_ns_, arrival_ns);
    while (twin_->camera_lost(k) && arrival_ns(k) <= deadline.time_ns()) ++k;
    if (arrival_ns(k) > deadline.time_ns()) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, "no frame before the deadline");
    }
    if (projections_) take_light(k);
    draw(k, frame);
    sleep_until_ns(arrival_ns(k));
    next_ = k + 1;
    return {};
  }

  /// Draws two images. The first one creates the surfaces of the true hands; the second one gives
  /// the drawing time.
  void warm_up() {
    renderer::Image<std::uint8_t> image(model_.width_px, model_.height_px);
    twin_->camera_image(0, image.view());
    const std::int64_t begin_ns = now_ns();
    twin_->camera_image(0, image.view());
    drawing_ns_ = std::min(now_ns() - begin_ns, kLongestDrawing_ns);
  }

 private:
  /// Takes the light as it is published, until that of the whole exposure must have been: a frame
  /// is published before it is lit, or `kPublishing_ns` later if the projector has no latency.
  void take_light(std::uint64_t k) {
    constexpr std::int64_t kPublishing_ns = 3'000'000;
    const auto until = Deadline::at_ns(epoch_ns_ + twin_->camera_origin_ns(k) + exposure_ns_ / 2 +
                                       kPublishing_ns + early_ns_);
    do {
      if (const auto projection = projections_->next(until)) light_->add(**projection);
    } while (!until.passed());
  }

  void draw(std::uint64_t k, msg::CameraFrame& frame) {
    const std::int64_t begin_ns = now_ns();
    frame.header.frame_id = k;
    frame.header.origin_ns = epoch_ns_ + twin_->camera_stamp_ns(k);
    frame.exposure_ns = exposure_ns_;
    frame.width_px = static_cast<std::uint32_t>(model_.width_px);
    frame.height_px = static_cast<std::uint32_t>(model_.height_px);
    const renderer::View<std::uint8_t> image{frame.pixels(), model_.width_px, model_.height_px,
                                             model_.width_px};
    if (const auto light =
            light_ ? light_->during(epoch_ns_ + twin_->camera_origin_ns(k), exposure_ns_)
                   : std::nullopt)
      twin_->camera_image(k, *light, image);
    else
      twin_->camera_image(k, image);
    drawing_ns_ += (std::min(now_ns() - begin_ns, kLongestDrawing_ns) - drawing_ns_) / 8;
  }

  std::unique_ptr<twin::Twin> twin_;
  calib::CameraModel model_;
  std::int64_t exposure_ns_, epoch_ns_;
  std::int64_t drawing_ns_ = 0;  ///< smoothed time to draw an image
  std::uint64_t next_ = 0;
  std::optional<SeenLight> light_;  ///< empty without a board
  std::int64_t early_ns_ = 0;       ///< how much earlier than reported the light comes
  std::optional<ipc::Reader<msg::Projection>> projections_;
};

}  // namespace

Result<std::unique_ptr<Camera>> open_twin(const Opening& with) {
  const auto& rig = with.rig;
  auto twin = twin::Twin::create(rig, with.calibration, with.at);
  if (!twin) return tl::make_unexpected(twin.error());
  auto camera = std::make_unique<TwinCamera>(std::move(*twin), with.settings, with.camera.model,
                                             with.epoch_ns);
  if (rig.twin.prop.kind == config::TwinPropKind::board)
    if (auto shown = camera->show_board(rig.twin.prop, rig.projector); !shown)
      return fail_in("twin.prop.board", shown.error());
  camera->warm_up();
  return camera;
}

}  // namespace handcast::camera
