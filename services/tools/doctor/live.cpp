// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/live.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "config/live/live_board.hpp"
#include "config/rig.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::doctor {
namespace {

constexpr int kSaturated = 250;
constexpr double kMostSaturated = 0.002;
/// The captures of the paper's rig: hands of 41 to 83 before a background of 9 to 17.
/// @{
constexpr int kBrightBackground = 40;
constexpr int kDarkHand = 35;
/// @}

}  // namespace

void Greys::add(std::span<const std::uint8_t> pixels) {
  for (const auto pixel : pixels) ++histogram_[pixel];
  count_ += pixels.size();
}

int Greys::percentile(double share) const {
  std::uint64_t below = 0;
  for (int grey = 0; grey < 255; ++grey) {
    below += histogram_[static_cast<std::size_t>(grey)];
    if (static_cast<double>(below) >= share * static_cast<double>(count_)) return grey;
  }
  return 255;
}

double Greys::share_from(int grey) const {
  std::uint64_t above = 0;
  for (std::size_t i = static_cast<std::size_t>(grey); i < histogram_.size(); ++i)
    above += histogram_[i];
  return count_ == 0 ? 0 : static_cast<double>(above) / static_cast<double>(count_);
}

std::vector<Finding> judge_images(const Greys& greys, bool has_hand) {
  std::vector<Finding> findings;
  const double saturated = greys.share_from(kSaturated);
  if (saturated > kMostSaturated)
    findings.push_back({"exposure", Grade::advice,
                        fmt::format("{:.1f} % of the pixels are saturated", 100 * saturated),
                        "lower camera.exposure_ms, or the infrared lamp"});
  else
    findings.push_back(
        {"exposure", Grade::good, fmt::format("{:.2f} % saturated", 100 * saturated), ""});

  const int background = greys.percentile(0.5);
  if (background > kBrightBackground)
    findings.push_back(
        {"background", Grade::advice, fmt::format("its grey value is {}", background),
         "keep daylight and the projector's light from the camera: a filter, dark cloth"});
  else
    findings.push_back({"background", Grade::good, fmt::format("grey value {}", background), ""});

  if (!has_hand) return findings;
  const int hand = greys.percentile(0.995);
  if (hand < kDarkHand || hand < 2 * background)
    findings.push_back(
        {"infrared light", Grade::advice,
         fmt::format("the brightest pixels have the grey value {}, the background {}", hand,
                     background),
         "more infrared light on the hand, or a longer camera.exposure_ms"});
  else
    findings.push_back({"infrared light", Grade::good,
                        fmt::format("hand {}, background {}", hand, background), ""});
  return findings;
}

namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr double kHeld = 0.95;                       ///< share of the wanted rate
constexpr double kMostMissed = 0.01;                 ///< share of the refreshes
constexpr double kMostLost = 0.01;                   ///< share of the images
constexpr double kWorstClock_us = 200;               ///< at 1 m/s, 0.2 mm
constexpr std::int64_t kLookEvery_ns = 100'000'000;  ///< at the pixels of an image

/// What was seen of the sensors.
struct Seen {
  Greys greys;
  std::int64_t worst_clock_ns = 0;
  std::uint64_t images = 0, searched = 0, with_hand = 0;
  std::uint64_t tracked = 0, tracked_with_hand = 0;  ///< samples of the tracker
};

void look_at(const msg::CameraFrame& frame, std::int64_t& next_look_ns, Seen& seen) {
  ++seen.images;
  seen.worst_clock_ns = std::max(seen.worst_clock_ns, frame.origin_error_ns);
  if (now_ns() < next_look_ns) return;
  next_look_ns = now_ns() + kLookEvery_ns;
  seen.greys.add({frame.pixels(), frame.used_bytes() - sizeof(msg::CameraFrame)});
}

Result<Seen> watch(const std::string& rig, double seconds) {
  auto frames = client::open_stream<msg::CameraFrame>(rig, "camera.frames");
  if (!frames) return tl::make_unexpected(std::move(frames.error()));
  auto landmarks = client::open_stream<msg::Landmarks>(rig, "landmarks.hands");
  auto poses = client::open_stream<msg::HandPoses>(rig, "pose.hands");
  Seen seen;
  const std::int64_t begun_ns = now_ns();
  // A ring still has what was published before a service stopped.
  const auto is_new = [begun_ns](const auto& message) {
    return message.header.published_ns >= begun_ns;
  };
  std::int64_t next_look_ns = 0;
  for (const auto end = Deadline::at_ns(now_ns() + seconds_to_ns(seconds)); !end.passed();) {
    const auto frame = frames->latest(Deadline::in(100ms));
    if (frame && is_new(**frame)) look_at(**frame, next_look_ns, seen);
    if (!frame && frame.error().code == Errc::disconnected)
      return tl::make_unexpected(frame.error());
    while (poses) {
      const auto sample = poses->next(Deadline::now());
      if (!sample) break;
      if (!is_new(**sample)) continue;
      ++seen.tracked;
      seen.tracked_with_hand += (*sample)->count > 0;
    }
    if (!landmarks) continue;
    while (const auto found = landmarks->next(Deadline::now())) {
      if (!is_new(**found)) continue;
      ++seen.searched;
      seen.with_hand += (*found)->count > 0;
    }
  }
  return seen;
}

double number_in(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number() ? found->get<double>() : 0;
}

/// A member that should be an object; an empty one if it is not.
json object_in(const json& object, const std::string& name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_object() ? *found : json::object();
}

json ring_in(const json& status, const std::string& ring) {
  return object_in(object_in(status, "rings"), ring);
}

std::vector<Finding> services_in(const json& status) {
  std::vector<Finding> findings;
  const auto services = object_in(status, "services");
  for (const auto& [name, service] : services.items()) {
    const auto state = service.value("state", std::string("unknown"));
    if (state == "ready") continue;
    findings.push_back({name, Grade::fault, fmt::format("it is {}", state),
                        "`handcast status` shows its last words"});
  }
  if (findings.empty()) findings.push_back({"services", Grade::good, "all are ready", ""});
  return findings;
}

Finding clock_of(const Seen& seen) {
  if (seen.images == 0)
    return {"camera clock", Grade::fault, "no image came", "`handcast status`, and its log"};
  if (seen.worst_clock_ns == 0)
    return {"camera clock", Grade::good, "images are stamped on this computer's clock", ""};
  const double worst_us = ns_to_us(seen.worst_clock_ns);
  const auto sentence = fmt::format("the time of an image is known to {:.0f} us", worst_us);
  if (worst_us <= kWorstClock_us) return {"camera clock", Grade::good, sentence, ""};
  return {"camera clock", Grade::advice, sentence,
          "give the camera service a core and a real-time priority ([camera.process])"};
}

Finding losses_in(const json& status, const Seen& seen) {
  const auto lost = object_in(status, "lost_images");
  const double on_the_way =
      number_in(lost, "missing") + number_in(lost, "incomplete") + number_in(lost, "underrun");
  const auto sentence = fmt::format("{:.0f} since the start of the rig, {:.0f} skipped", on_the_way,
                                    number_in(lost, "skipped"));
  const double images =
      number_in(ring_in(status, "camera.frames"), "count") + static_cast<double>(seen.images == 0);
  if (on_the_way <= kMostLost * images) return {"lost images", Grade::good, sentence, ""};
  return {"lost images", Grade::advice, sentence,
          "packet size and socket buffers (GigE), the USB port, or a lower camera.rate_hz"};
}

Finding hands_in(const Seen& seen) {
  if (seen.searched == 0)
    return {"hand", Grade::fault, "the detector delivers nothing", "`handcast status`"};
  const auto percent =
      100. * static_cast<double>(seen.with_hand) / static_cast<double>(seen.searched);
  const auto sentence = fmt::format("seen in {:.0f} % of the searched images", percent);
  if (seen.with_hand > 0) return {"hand", Grade::good, sentence, ""};
  return {"hand", Grade::advice, sentence,
          "hold a hand in the camera's view while the doctor looks; `handcast preview` shows it"};
}

Finding tracker_of(const Seen& seen, double seconds) {
  if (seen.tracked == 0)
    return {"tracker", Grade::fault, "the pose service delivers nothing",
            "`handcast status` shows its last words"};
  const auto sentence = fmt::format(
      "{:.0f} samples a second, a hand in {:.0f} %", static_cast<double>(seen.tracked) / seconds,
      100. * static_cast<double>(seen.tracked_with_hand) / static_cast<double>(seen.tracked));
  if (seen.tracked_with_hand > 0) return {"tracker", Grade::good, sentence, ""};
  return {"tracker", Grade::advice, sentence,
          "hold a hand in the tracker's view while the doctor looks"};
}

/// What a person, a cue or the night watch has switched off is no fault.
std::optional<Finding> darkness_of(const std::string& rig) {
  const auto now =
      config::LiveBoard::open(rig).and_then([](const auto& board) { return board.rig_now(); });
  const auto why = now ? config::why_dark(now->light) : std::string();
  if (why.empty()) return std::nullopt;
  return Finding{"light", Grade::advice, why + ": the hands are dark",
                 "`handcast blackout off`, `handcast master 1`, or the night watch's hours"};
}

/// `before`: the status some seconds ago.
Finding light_of(const json& before, const json& status, const std::string& projector,
                 double shown) {
  const auto check = "light of " + projector;
  const auto light = object_in(object_in(status, "light"), projector);
  if (light.empty())
    return {check, Grade::fault, "none came",
            fmt::format("`handcast status` says why {} waits", projector)};
  const double all = number_in(light, "missed_refreshes"),
               missed = all - number_in(object_in(object_in(before, "light"), projector),
                                        "missed_refreshes");
  const auto sentence = fmt::format(
      "{:.0f} refreshes without a new frame, {:.0f} since the start of the rig; times by the {}",
      missed, all, light.value("times_by", std::string("?")));
  if (missed <= kMostMissed * shown) return {check, Grade::good, sentence, ""};
  return {check, Grade::fault, sentence,
          fmt::format("lower {0}.rate_hz, or give it a core ([{0}.process])", projector)};
}

/// The rate and the light of each projector of the rig.
void judge_projectors(const json& before, const json& status, std::vector<Finding>& findings) {
  for (const auto at : {config::Viewpoint::first, config::Viewpoint::second}) {
    const auto projector = config::name_at_projector(at, "projector");
    const auto stream = config::name_at_projector(at, "projection.frames");
    const auto ring = ring_in(status, stream);
    if (ring.empty() && at == config::Viewpoint::second) continue;
    findings.push_back(judge_rate(ring, projector + " rate", projector + ".rate_hz"));
    const double shown = number_in(ring, "count") - number_in(ring_in(before, stream), "count");
    findings.push_back(light_of(before, status, projector, shown));
  }
}

}  // namespace

Finding judge_rate(const json& ring, const std::string& check, const std::string& setting) {
  const double wanted_hz = number_in(ring, "wanted_hz"), held_hz = number_in(ring, "held_hz");
  const auto sentence = fmt::format("{:.1f} Hz of {:.1f} Hz", held_hz, wanted_hz);
  const bool is_enough = held_hz >= kHeld * wanted_hz || !ring.value("is_held_to_it", true);
  if (is_enough && held_hz > 0) return {check, Grade::good, sentence, ""};
  return {check, Grade::fault, sentence,
          fmt::format("lower {}, or find what is slow with `handcast latency`", setting)};
}

Result<std::vector<Finding>> examine_live(const std::string& rig, double seconds) {
  const auto ask = [&] {
    return control::ask(rig, {.verb = control::Verb::status}).map([](const json& answer) {
      return object_in(answer, "status");
    });
  };
  const auto before = ask();
  if (!before) return tl::make_unexpected(before.error());
  const auto seen = watch(rig, seconds);
  if (!seen) return tl::make_unexpected(seen.error());
  const auto answer = ask();
  if (!answer) return tl::make_unexpected(answer.error());
  const auto& status = *answer;
  auto findings = services_in(status);
  findings.push_back(judge_rate(ring_in(status, "camera.frames"), "camera rate", "camera.rate_hz"));
  findings.push_back(clock_of(*seen));
  findings.push_back(losses_in(status, *seen));
  findings.push_back(hands_in(*seen));
  findings.push_back(tracker_of(*seen, seconds));
  if (!seen->greys.empty()) {
    auto images = judge_images(seen->greys, seen->with_hand > 0);
    findings.insert(findings.end(), images.begin(), images.end());
  }
  judge_projectors(*before, status, findings);
  if (auto dark = darkness_of(rig)) findings.push_back(std::move(*dark));
  return findings;
}

}  // namespace handcast::doctor
