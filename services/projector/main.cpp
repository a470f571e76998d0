// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>

#include "ipc/base/log.hpp"
#include "ipc/base/prefault.hpp"
#include "renderer/draw/choose/open_painter.hpp"
#include "services/projector/brightness.hpp"
#include "services/projector/inputs.hpp"
#include "services/projector/other_light.hpp"
#include "services/projector/projector.hpp"
#include "services/projector/show.hpp"
#include "services/projector/test_pictures.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using service::must;

using config::Viewpoint;

/// Opens what the frames are drawn from and shown on, and shows them until the service ends.
static void run_projector(service::Context& context, Viewpoint at) {
  const auto rig = config::rig_at_projector(context.rig(), at);
  const auto calibration = calib::at_projector(context.calibration(), at);
  const auto name = config::name_at_projector(at, "projector");
  const int threads = rig.projector.painter_threads;
  const auto cores = rig.projector.process.cores.size();
  if (cores > 0 && threads > static_cast<int>(cores))
    log::warning(
        "{0}.painter_threads: {1} threads share {2} of {0}.process.cores; give them a core each",
        name, threads, cores);
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
                                        calibration.projector.height_px, at);
  projector::Brightness brightness(rig.projector, rig.light, context.epoch_ns());
  const auto live_settings = must(context.live_settings());
  projector::LiveLight live(*live_settings, rig, at, *pipeline, brightness,
                            calibration.projector.width_px, calibration.projector.height_px);
  std::optional<projector::OtherLight> other;
  if (calibration.projector2)
    other.emplace(must(context.reader<msg::Projection>(
                      config::name_at_projector(other_of(at), "projection.frames"))),
                  config::rig_at_projector(context.rig(), other_of(at)).projector.rate_hz);
  auto projections =
      must(context.writer<msg::Projection>(config::name_at_projector(at, "projection.frames")));
  auto* const show = rig.projector.packing == config::Packing::none ? projector::show_frames
                                                                    : projector::show_sub_frames;
  show(context, {rig.projector, calibration, *pipeline, inputs, test_pictures, *projector,
                 brightness, live, std::move(other), std::move(projections)});
}

/// The back end is not opened: it would write files or light up.
static Result<void> check_projector(const config::Rig& rig, const calib::Calibration& calibration,
                                    Viewpoint at) {
  if (at == Viewpoint::second && !calibration.projector2)
    return fail(Errc::bad_config, "projector2.backend is \"none\"");
  const auto pipeline = renderer::Pipeline::create(rig.cascade, rig.content, rig.hand,
                                                   calib::at_projector(calibration, at));
  return pipeline ? Result<void>() : tl::make_unexpected(pipeline.error());
}

static service::Instance instance_at(Viewpoint at) {
  const auto named = [at](const char* name) { return config::name_at_projector(at, name); };
  const auto other = config::name_at_projector(other_of(at), "projection.frames");
  auto backends = service::describe_rows(projector::projector_backends());
  for (auto& backend : backends)
    for (auto& setting : backend.settings) setting = config::name_at_projector(at, setting);
  return {{.name = named("projector"),
           .summary = at == Viewpoint::first
                          ? "Projects light onto the hands that the sensors see."
                          : "Of a second projector: projects light onto the same hands.",
           .paced_by = named("projector.rate_hz"),
           .publishes = {named("projection.frames")},
           .subscribes = {"camera.frames", "pose.hands", "landmarks.hands", "content.left",
                          "content.right", other, std::string(msg::kTestPictures)},
           .settings = {named("projector"), "light", "content.shading", "content.smooth", "hand",
                        "cascade", "projector2.backend", "projector2.calibration"},
           .backends = std::move(backends)},
          [at](service::Context& context) { run_projector(context, at); },
          [at](const config::Rig& rig, const calib::Calibration& calibration) {
            return check_projector(rig, calibration, at);
          }};
}

int main(int argc, char** argv) {
  return service::run(std::array{instance_at(Viewpoint::first), instance_at(Viewpoint::second)},
                      argc, argv);
}
