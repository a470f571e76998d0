// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "calib/sub_frames.hpp"
#include "renderer/output/packing.hpp"
#include "services/projector/delay_meter.hpp"
#include "services/projector/last_light.hpp"
#include "services/projector/pacing.hpp"
#include "services/projector/show.hpp"
#include "services/projector/sub_frame_messages.hpp"
#include "services/projector/sub_frame_plan.hpp"

namespace handcast::projector {
namespace {

std::unique_ptr<renderer::Packer> packer_for(const calib::Calibration& calibration,
                                             const config::Projector& settings) {
  const auto output = calib::output_of(calibration, settings.packing);
  return renderer::make_packer(settings, output.projector.width_px, output.projector.height_px);
}

/// The levels of a packed frame are those of the projector.
renderer::LightTable unchanged() {
  renderer::LightTable table{};
  for (std::size_t level = 0; level < table.size(); ++level)
    table[level] = static_cast<std::uint8_t>(level);
  return table;
}

/// Draws, packs and hands over one output frame after the other.
class SubFrameLoop {
 public:
  SubFrameLoop(service::Context& context, Show show)
      : context_(context),
        show_(std::move(show)),
        last_light_(context, show_.brightness),
        packer_(packer_for(show_.calibration, show_.settings)),
        plan_(show_.settings),
        messages_(std::move(show_.projections),
                  [&context](const auto& header, auto stages, const auto& made_from) {
                    context.mark(header, stages, made_from);
                  }) {}

  void run() {
    for (std::int64_t output_id = 0; draw_all(); ++output_id)
      if (!present(output_id)) return;
  }

 private:
  /// Draws the sub-frames. False if the service ends.
  bool draw_all() {
    plan_.start(now_ns());
    if (show_.live.follow(now_ns()))
      packer_ = packer_for(show_.calibration, *show_.live.settings());
    packer_->begin(show_.brightness.fade_at(now_ns()));
    renderer::Frame frame;
    while (const auto next = plan_.next(now_ns())) {
      if (!sleep_and_publish(next->begin_ns)) return false;
      const std::int64_t start_ns = now_ns();
      frame = draw(*next);
      plan_.drawn(*next, now_ns() - start_ns);
    }
    if (const int left = plan_.left_to_draw(); left > 0) {
      packer_->add(frame.colour, frame.region, sub_frames() - left, left);
      messages_.extend(left);
    }
    return true;
  }

  renderer::Frame draw(const SubFramePlan::Drawing& drawing) {
    if (const auto delivered = show_.take_inputs(Deadline::now()); !delivered)
      context_.tolerate(delivered.error());
    const std::int64_t begin_ns = now_ns();
    const auto* picture = show_.test_pictures.at(begin_ns, drawing.target_ns, show_.live.flip());
    const DelayMeter meter;
    if (!show_.live.is_frozen() || !has_frame_ || picture)
      frame_ = picture ? *picture
                       : show_.pipeline.render(begin_ns, drawing.target_ns, show_.inputs.image());
    frame_.target_ns = drawing.target_ns;
    has_frame_ = !picture;
    const auto delay = meter.delay();
    packer_->add(frame_.colour, frame_.region, drawing.first, drawing.count);
    messages_.keep(frame_, drawing.count, delay);
    return frame_;
  }

  /// Hands the output frame over. False if the service ends.
  bool present(std::int64_t output_id) {
    if (!has_rhythm_ && !sleep_and_publish(plan_.hand_over_ns())) return false;
    renderer::Frame output;
    output.colour = packer_->image();
    output.region = packer_->region();
    const auto times =
        show_.projector.present(output, output_id, unchanged_,
                                Deadline::at_ns(now_ns() + 50'000'000 + plan_.output_period_ns()));
    if (!times) {
      messages_.drop();
      context_.tolerate(times.error());
      return true;
    }
    last_light_.presented();
    has_rhythm_ = times->next_ns != 0;
    plan_.presented(*times);
    messages_.handed_over(plan_, static_cast<std::uint64_t>(output_id * sub_frames()), *times);
    return true;
  }

  /// Publishes the messages that are due until `time_ns`. False if the service ends.
  bool sleep_and_publish(std::int64_t time_ns) {
    const auto running = [this] { return last_light_.goes_on(); };
    for (;;) {
      messages_.publish(now_ns());
      const std::int64_t due_ns = messages_.due_ns();
      if (!sleep_while(running, std::min(time_ns, due_ns))) return false;
      if (time_ns < due_ns) return true;
    }
  }
  int sub_frames() const { return config::sub_frames_of(show_.settings.packing); }

  const renderer::LightTable unchanged_ = unchanged();

  service::Context& context_;
  Show show_;
  LastLight last_light_;
  std::unique_ptr<renderer::Packer> packer_;
  SubFramePlan plan_;
  SubFrameMessages messages_;
  renderer::Frame frame_;  ///< the last one, if has_frame_
  bool has_frame_ = false;
  bool has_rhythm_ = false;  ///< the projector says when it takes the next output frame
};

}  // namespace

void show_sub_frames(service::Context& context, Show show) {
  SubFrameLoop loop(context, std::move(show));
  context.ready();
  loop.run();
}

}  // namespace handcast::projector
