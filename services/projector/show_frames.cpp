// SPDX-License-Identifier: Apache-2.0
#include "services/projector/delay_meter.hpp"
#include "services/projector/last_light.hpp"
#include "services/projector/pacing.hpp"
#include "services/projector/publish.hpp"
#include "services/projector/show.hpp"

namespace handcast::projector {

void show_frames(service::Context& context, Show show) {
  using namespace std::chrono_literals;
  auto& settings = show.settings;
  Pacer pacer(settings.rate_hz);
  Horizon horizon(settings);
  LastLight last_light(context, show.brightness);

  context.ready();
  const auto running = [&] { return last_light.goes_on(); };
  std::int64_t next_ns = pacer.next_ns(now_ns());
  renderer::Frame frame;
  bool has_frame = false;
  for (std::uint64_t frame_id = 0; sleep_while(running, next_ns); ++frame_id) {
    if (show.live.follow(now_ns())) settings = *show.live.settings();
    const auto image_deadline = Deadline::at_ns(now_ns() + ms_to_ns(settings.frame_wait_ms));
    if (const auto delivered = show.take_inputs(image_deadline); !delivered)
      context.tolerate(delivered.error());

    const std::int64_t begin_ns = now_ns();
    const std::int64_t target_ns = horizon.target_ns(begin_ns);
    const auto* picture = show.test_pictures.at(begin_ns, target_ns, show.live.flip());
    const DelayMeter meter;
    const bool is_frozen = show.live.is_frozen() && has_frame && !picture;
    if (!is_frozen)
      frame = picture ? *picture : show.pipeline.render(begin_ns, target_ns, show.inputs.image());
    frame.target_ns = target_ns;
    has_frame = !picture;
    const auto delay = meter.delay();
    const auto times =
        show.projector.present(frame, frame_id, show.brightness.at(now_ns()), Deadline::in(50ms));
    show.pipeline.read_back(frame);
    next_ns =
        times && times->next_ns != 0 ? horizon.begin_ns(times->next_ns) : pacer.next_ns(now_ns());
    if (!times) {
      context.tolerate(times.error());
      continue;
    }
    last_light.presented();
    horizon.learn(begin_ns, *times);
    publish_projection(frame, frame_id, *times, show.projections);
    if (is_frozen) continue;
    context.mark({frame_id, frame.made_from.image_ns}, TimeSheet(frame.stages, *times, delay),
                 frame.made_from);
  }
}

}  // namespace handcast::projector
