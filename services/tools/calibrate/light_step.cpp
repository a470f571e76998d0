// SPDX-License-Identifier: Apache-2.0
// The light on a still hand, and when it comes.
#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/number_text.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/tools/calibrate/hand_light.hpp"
#include "services/tools/calibrate/light_delay.hpp"
#include "services/tools/calibrate/steps.hpp"

namespace handcast::calibrate {
namespace {

constexpr std::size_t kEnoughImages = 200;
constexpr double kLook_s = 8;

/// Full light and none, in turns.
class Alternation {
 public:
  explicit Alternation(TestScreen& screen) : screen_(screen) {}

  /// Changes the light if it is time.
  void turn() {
    if (now_ns() - changed_ns_ < kEach_ns) return screen_.keep();
    is_full_ = !is_full_;
    screen_.show_level(is_full_ ? 255 : 0);
    changed_ns_ = now_ns();
  }
  /// What there was at a time; unknown until any delay of the light is over.
  Lighting at(std::int64_t time_ns) const {
    if (changed_ns_ == 0 || time_ns < changed_ns_ + kSettling_ns) return Lighting::unknown;
    return is_full_ ? Lighting::full : Lighting::dark;
  }

 private:
  static constexpr std::int64_t kEach_ns = 700'000'000, kSettling_ns = 250'000'000;

  TestScreen& screen_;
  bool is_full_ = false;
  std::int64_t changed_ns_ = 0;
};

/// Adds landmarks with their image. False if they are not of one hand, or the image is gone.
bool look(const msg::Landmarks& found, client::Stream<msg::CameraFrame>& frames,
          const Alternation& alternation, HandLight& light) {
  if (found.count != 1) return false;
  const auto origin_ns = found.header.origin_ns;
  const auto frame = frames.at(origin_ns);
  if (!frame || (*frame)->header.origin_ns != origin_ns) return false;
  light.add(view_of(**frame), found.hands[0], alternation.at(origin_ns));
  return true;
}

/// Watches a hand until enough was seen, Enter is pressed or the time is over.
Result<HandLight> watch(Desk& desk) {
  auto landmarks = client::open_stream<msg::Landmarks>(desk.rig.name, "landmarks.hands");
  if (!landmarks) return tl::make_unexpected(landmarks.error());
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  HandLight light(desk.used.camera);
  Alternation alternation(desk.screen);
  Progress progress(desk, "light");
  std::int64_t first_ns = 0;
  while (progress.goes_on()) {
    const double share =
        std::min(static_cast<double>(light.images()) / static_cast<double>(kEnoughImages),
                 first_ns == 0 ? 0 : ns_to_seconds(now_ns() - first_ns) / kLook_s);
    if (share >= 1) break;
    if (first_ns == 0) {
      progress.show(share, "Hold one open hand still in the middle");
    } else {
      progress.say(share, "Hold the hand still; the light changes");
      alternation.turn();
    }
    const auto found = progress.next(*landmarks);
    if (found && look(**found, *frames, alternation, light) && first_ns == 0) first_ns = now_ns();
  }
  return progress.result().map([&] { return std::move(light); });
}

std::string made_of(const HandLight& light) {
  return fmt::format(
      "grey values of {} images: hand {}, finger tips {}, background {}; the projector's light "
      "adds {} to the hand; the hand's brightness varies by {:.1f} %",
      light.images(), light.hand().percentile(0.5), light.tips().percentile(0.5),
      light.background().percentile(0.5), number_text(std::max(0.0, light.leak()), 0),
      100 * light.flicker());
}

/// Looks at a still hand in the projector's light and without it, and advises on exposure,
/// threshold, flicker and the projector's light in the camera. Changes nothing in the draft.
/// Errors: bad_data (no hand was seen), those of the streams, of the rig and of the photodiode.
Result<Outcome> measure_light(Desk& desk) {
  Outcome outcome;
  if (!desk.options.photodiode.empty()) {
    fmt::print(stderr, "  measuring the delay of the light with the photodiode\n");
    const auto delay = measure_delay_by_sound(desk);
    if (!delay) return tl::make_unexpected(delay.error());
    report_delay(desk.rig, *delay, outcome);
  }
  const auto light = watch(desk);
  if (!light) return tl::make_unexpected(light.error());
  if (light->images() == 0)
    return fail(Errc::bad_data,
                "no image with exactly one hand was seen: hold one open hand in the camera's view");
  outcome.made = made_of(*light);
  const double period_ms = 1e3 / desk.rig.camera.rate_hz;
  auto advice = advice_on(
      *light, {desk.rig.camera.exposure_ms, 0.95 * period_ms, desk.rig.cascade.mask.threshold});
  if (advice.empty())
    advice.push_back(
        "exposure and infrared light are good; a threshold between hand and "
        "background would be " +
        std::to_string(threshold_between(*light)));
  outcome.findings.insert(outcome.findings.begin(), advice.begin(), advice.end());
  outcome.meaning =
      "Grey values are medians of 0 (black) to 255 (saturated). The projector's light: full light "
      "less none on the hand, which a filter before the camera should keep near 0";
  outcome.pictures = {histograms_picture(*light)};
  return outcome;
}

std::vector<std::string> scene(const Options& /*options*/, double /*camera_hz*/) {
  return {"twin.motion=builtin:still", "twin.hands=left"};
}

const char* instruct(const Options& /*options*/) {
  return "Hold one open hand still in the middle of the camera's view, for ten seconds. The "
         "projector lights it white and dark in turns.";
}

}  // namespace

const StepEntry kLightStep{
    .step = Step::light, .scene = scene, .instruct = instruct, .measure = measure_light};

}  // namespace handcast::calibrate
