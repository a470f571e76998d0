// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/choose/open_painter.hpp"
#include "services/projector/brightness.hpp"
#include "services/projector/inputs.hpp"
#include "services/projector/last_light.hpp"
#include "services/projector/pacing.hpp"
#include "services/projector/publish.hpp"
#include "services/projector/show_sub_frames.hpp"
#include "services/projector/test_pictures.hpp"
#include "services/projector/time_sheet.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// Draws and presents one frame per projector period, and publishes it to the ring
/// projection.frames.
static void run_projector(service::Context& context) {
  const auto& rig = context.rig();
  const auto& calibration = context.calibration();
  // An output that only one process may use is opened last, and has no share group.
  std::unique_ptr<projector::Projector> projector;
  if (!service::is_exclusive(rig.projector.backend, projector::projector_backends()))
    projector = must(projector::open_projector(rig, calibration));
  const auto shares = projector ? projector->share_group() : renderer::ShareGroup();
  const auto pipeline = must(renderer::Pipeline::create(
      rig.cascade, rig.content, rig.hand, calibration, {},
      renderer::open_painter(rig.projector.painter, calibration.projector_width_px,
                             calibration.projector_height_px, shares)));
  pipeline->show_surface(true);  // an observer may come at any time
  context.stand_by();
  if (!projector) projector = must(projector::open_projector(rig, calibration));
  projector::Inputs inputs(must(context.reader<msg::CameraFrame>("camera.frames")),
                           must(context.reader<msg::HandPoses>("pose.hands")),
                           must(context.reader<msg::Landmarks>("landmarks.hands")), calibration.id);
  projector::TestPictures test_pictures(must(context.reader<msg::TestPicture>(msg::kTestPictures)),
                                        calibration.projector_width_px,
                                        calibration.projector_height_px);
  projector::Brightness brightness(rig.projector, context.epoch_ns());
  auto projections = must(context.writer<msg::Projection>("projection.frames"));
  if (rig.projector.packing != config::Packing::none)
    return projector::show_sub_frames(context, {*pipeline, inputs, test_pictures, *projector,
                                                brightness, std::move(projections)});
  projector::Pacer pacer(rig.projector.rate_hz);
  projector::Horizon horizon(rig.projector);
  projector::LastLight last_light(context, brightness);

  context.ready();
  const auto running = [&] { return last_light.goes_on(); };
  std::int64_t next_ns = pacer.next_ns(now_ns());
  for (std::uint64_t frame_id = 0; projector::sleep_while(running, next_ns); ++frame_id) {
    const Deadline image_deadline =
        Deadline::at_ns(now_ns() + ms_to_ns(rig.projector.frame_wait_ms));
    if (const auto delivered = inputs.deliver(*pipeline, image_deadline); !delivered)
      context.tolerate(delivered.error());

    const std::int64_t begin_ns = now_ns();
    const std::int64_t target_ns = horizon.target_ns(begin_ns);
    const auto* picture = test_pictures.at(begin_ns, target_ns);
    auto frame = picture ? *picture : pipeline->render(begin_ns, target_ns, inputs.image());
    const std::int64_t drawn_ns = now_ns();
    const auto times =
        projector->present(frame, frame_id, brightness.at(drawn_ns), Deadline::in(50ms));
    pipeline->read_back(frame);
    next_ns =
        times && times->next_ns != 0 ? horizon.begin_ns(times->next_ns) : pacer.next_ns(now_ns());
    if (!times) {
      context.tolerate(times.error());
      continue;
    }
    last_light.presented();
    horizon.learn(begin_ns, *times);
    projector::publish_projection(frame, frame_id, *times, projections);
    context.mark({frame_id, frame.made_from.image_ns},
                 projector::time_sheet(frame.stages, begin_ns, drawn_ns, *times), frame.made_from);
  }
}

/// The back end is not opened: it would write files or light up.
static Result<void> check_projector(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto pipeline = renderer::Pipeline::create(rig.cascade, rig.content, rig.hand, calibration);
  return pipeline ? Result<void>() : tl::make_unexpected(pipeline.error());
}

int main(int argc, char** argv) {
  return service::run({.name = "projector",
                       .summary = "Projects light onto the hands that the sensors see.",
                       .paced_by = "projector.rate_hz",
                       .publishes = {"projection.frames"},
                       .subscribes = {"camera.frames", "pose.hands", "landmarks.hands",
                                      std::string(msg::kTestPictures)},
                       .settings = {"projector", "content", "hand", "cascade"},
                       .backends = service::describe_rows(projector::projector_backends())},
                      argc, argv, run_projector, check_projector);
}
