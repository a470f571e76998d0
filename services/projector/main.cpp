// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/log.hpp"
#include "ipc/base/prefault.hpp"
#include "renderer/draw/choose/open_painter.hpp"
#include "services/projector/brightness.hpp"
#include "services/projector/inputs.hpp"
#include "services/projector/projector.hpp"
#include "services/projector/show.hpp"
#include "services/projector/test_pictures.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using service::must;

/// Opens what the frames are drawn from and shown on, and shows them until the service ends.
static void run_projector(service::Context& context) {
  const auto& rig = context.rig();
  const auto& calibration = context.calibration();
  const int threads = rig.projector.painter_threads;
  const auto cores = rig.projector.process.cores.size();
  if (cores > 0 && threads > static_cast<int>(cores))
    log::warning(
        "projector.painter_threads: {} threads share {} of projector.process.cores; give them a "
        "core each",
        threads, cores);
  // An output that only one process may use is opened last, and has no share group.
  std::unique_ptr<projector::Projector> projector;
  if (!service::is_exclusive("projector", rig.projector.backend, projector::projector_backends()))
    projector = must(projector::open_projector(rig, calibration));
  const auto shares = projector ? projector->share_group() : renderer::ShareGroup();
  const auto pipeline = must(renderer::Pipeline::create(
      rig.cascade, rig.content, rig.hand, calibration, {},
      renderer::open_painter(rig.projector.painter, calibration.projector.width_px,
                             calibration.projector.height_px, shares, threads)));
  pipeline->show_surface(true);  // an observer may come at any time
  prefault_memory();             // before the turn of a standby, which must be short
  context.stand_by();
  if (!projector) projector = must(projector::open_projector(rig, calibration));
  projector::Inputs inputs(must(context.reader<msg::CameraFrame>("camera.frames")),
                           must(context.reader<msg::HandPoses>("pose.hands")),
                           must(context.reader<msg::Landmarks>("landmarks.hands")),
                           {must(context.reader<msg::ContentPicture>("content.left")),
                            must(context.reader<msg::ContentPicture>("content.right"))},
                           calibration.id);
  projector::TestPictures test_pictures(must(context.reader<msg::TestPicture>(msg::kTestPictures)),
                                        calibration.projector.width_px,
                                        calibration.projector.height_px);
  projector::Brightness brightness(rig.projector, rig.light, context.epoch_ns());
  const auto live_settings = must(context.live_settings());
  projector::LiveLight live(*live_settings, rig, *pipeline, brightness,
                            calibration.projector.width_px, calibration.projector.height_px);
  auto projections = must(context.writer<msg::Projection>("projection.frames"));
  auto* const show = rig.projector.packing == config::Packing::none ? projector::show_frames
                                                                    : projector::show_sub_frames;
  show(context,
       {*pipeline, inputs, test_pictures, *projector, brightness, live, std::move(projections)});
}

/// The back end is not opened: it would write files or light up.
static Result<void> check_projector(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto pipeline = renderer::Pipeline::create(rig.cascade, rig.content, rig.hand, calibration);
  return pipeline ? Result<void>() : tl::make_unexpected(pipeline.error());
}

int main(int argc, char** argv) {
  return service::run(
      {.name = "projector",
       .summary = "Projects light onto the hands that the sensors see.",
       .paced_by = "projector.rate_hz",
       .publishes = {"projection.frames"},
       .subscribes = {"camera.frames", "pose.hands", "landmarks.hands", "content.left",
                      "content.right", std::string(msg::kTestPictures)},
       .settings = {"projector", "light", "content.shading", "content.smooth", "hand", "cascade"},
       .backends = service::describe_rows(projector::projector_backends())},
      argc, argv, run_projector, check_projector);
}
