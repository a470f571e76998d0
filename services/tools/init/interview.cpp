// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/interview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/rig_name.hpp"
#include "services/tools/devices/trackers.hpp"

namespace handcast::init {
namespace {

constexpr double kNearest_m = 0.1, kFarthest_m = 10;  // of pose.none.distance_m
constexpr std::string_view kNone = "none";

/// The back ends whose devices may be attached later.
constexpr std::array<std::string_view, 2> kCameraBackends{"aravis", "v4l2"},
    kLightBackends{"window", "kms"};

/// A question with a list, whose answer is kept in `chosen`. A device that is not attached yet is
/// answered with its back end and name: "v4l2:HD Webcam".
Question choice(const std::string& flag, const std::string& text,
                const std::vector<Candidate>& candidates, std::size_t likely, Candidate& chosen) {
  Question question{.flag = flag, .text = text, .options = {}, .preset = candidates[likely].word};
  for (const auto& candidate : candidates)
    question.options.push_back({candidate.word, candidate.text});
  question.take = [&, flag](const std::string& answer) -> Result<void> {
    const auto found = find(candidates, answer);
    if (found) return chosen = candidates[*found], Result<void>();
    const auto backends = flag == "--camera" ? kCameraBackends : kLightBackends;
    auto later =
        found.error().code == Errc::unavailable ? not_attached(answer, backends) : std::nullopt;
    if (later) return chosen = std::move(*later), Result<void>();
    return fail(found.error().code,
                fmt::format("{}; {}:NAME or {}:NAME is one that is not attached yet",
                            found.error().what, backends[0], backends[1]));
  };
  return question;
}

/// A real tracker among the devices; nullptr if there is none with this back end.
const devices::Attached* tracker_among(const std::vector<devices::Attached>& attached,
                                       std::string_view backend) {
  for (const auto& device : attached)
    if (device.kind == devices::Kind::tracker && device.settings.front().second == backend)
      return &device;
  return nullptr;
}

/// The words of the trackers that a rig of these devices can have.
std::vector<std::string_view> tracker_words(const std::vector<devices::Attached>& attached) {
  std::vector<std::string_view> words;
  for (const auto word : words_of(Tracker{}))
    if (word == kNone || word == "twin" || tracker_among(attached, word)) words.push_back(word);
  return words;
}

/// Why this computer has no such tracker: ": no device ..."; "" for other words.
std::string why_absent(const std::string& word) {
  if (word == "stereo")
    return ": for two cameras in place of a tracker copy config/rigs/stereo.toml, for both eyes of "
           "a Leap controller config/rigs/leap_stereo.toml, and the calibration that it names";
  for (const auto& [backend, why] : devices::absent_trackers())
    if (backend == word) return ": " + why;
  return "";
}

Result<void> take_tracker(const std::string& answer, const std::vector<devices::Attached>& attached,
                          Plan& plan) {
  const auto words = tracker_words(attached);
  const bool is_later = plan.camera.is_device() && (answer == "leapc" || answer == "openxr");
  if (std::ranges::find(words, answer) == words.end() && !is_later)
    return fail(Errc::bad_config, fmt::format("{} is not {}{}", quote(answer), join(words, " or "),
                                              why_absent(answer)));
  if (answer == "twin" && plan.camera.is_device())
    return fail(Errc::bad_config,
                "the twin's tracker does not see the hand in front of a real camera; take none");
  if (answer != "twin" && answer != kNone && !plan.camera.is_device())
    return fail(Errc::bad_config, "a real tracker does not see the twin's hand; take twin");
  const auto all = words_of(Tracker{});
  plan.tracker = static_cast<Tracker>(std::ranges::find(all, answer) - all.begin());
  const auto* device = tracker_among(attached, answer);
  plan.tracker_name = device ? device->name : "";
  if (!device && is_later)
    plan.tracker_name = fmt::format("{}, which is not there now{}", answer, why_absent(answer));
  return {};
}

/// A real tracker that can be used now, before none; with the twin's camera, its tracker.
std::string likely_tracker(const std::vector<devices::Attached>& attached, const Plan& plan) {
  if (!plan.camera.is_device()) return "twin";
  for (const auto& device : attached)
    if (device.kind == devices::Kind::tracker && device.trouble.empty())
      return device.settings.front().second;
  return std::string(kNone);
}

Question tracker_question(const std::vector<devices::Attached>& attached, Plan& plan) {
  Question question{.flag = "--tracker", .text = "Which hand tracker?"};
  question.preset = likely_tracker(attached, plan);
  if (!plan.camera.is_device()) question.options.push_back({"twin", "the digital twin's"});
  for (const auto word : tracker_words(attached))
    if (const auto* device = tracker_among(attached, word); device && plan.camera.is_device()) {
      const auto& trouble = device->trouble;
      question.options.push_back(
          {std::string(word),
           one_line(device->name + (trouble.empty() ? "" : "; cannot be used now: " + trouble))});
    }
  question.options.push_back({"none", "none: the hand is found in the camera's image alone"});
  question.take = [&attached, &plan](const std::string& answer) {
    return take_tracker(answer, attached, plan);
  };
  return question;
}

Result<void> take_distance(const std::string& answer, Plan& plan) {
  if (plan.tracker != Tracker::none)
    return fail(Errc::bad_config, "it counts only without a tracker; give --tracker none, too");
  double distance_m = 0;
  const auto* end = answer.data() + answer.size();
  const auto read = std::from_chars(answer.data(), end, distance_m);
  const std::string_view rest(read.ptr, end);
  if (read.ec != std::errc{} || (!rest.empty() && rest != "m" && rest != " m") ||
      !(distance_m >= kNearest_m && distance_m <= kFarthest_m))
    return fail(Errc::bad_config, fmt::format("{} is no number of metres from {} to {}",
                                              quote(answer), kNearest_m, kFarthest_m));
  plan.distance_m = distance_m;
  return {};
}

Question distance_question(Plan& plan) {
  return {.flag = "--distance",
          .text = "How far from the camera will the hand be, in metres?",
          .options = {},
          .preset = fmt::format("{}", plan.distance_m),
          .take = [&plan](const std::string& answer) { return take_distance(answer, plan); }};
}

/// Whether a calibration is one of the plan's devices.
Result<void> check_fits(const calib::Calibration& calibration, const Plan& plan) {
  const auto check = [](const char* what, const std::string& calibrated, const Candidate& ours) {
    if (!ours.is_device()) return Result<void>();
    for (const auto& name : ours.device.names)
      if (name == calibrated) return Result<void>();
    return calib::check_device(what, calibrated, {ours.name});
  };
  if (auto same = check("camera", calibration.camera_device, plan.camera); !same) return same;
  return check("projector", calibration.projector_device, plan.light);
}

Result<void> take_calibration(const std::string& answer, Plan& plan) {
  plan.calibration_file.clear();
  plan.calibration.reset();
  if (answer == kNone) return {};
  auto calibration = calib::load_calibration(answer);
  if (!calibration) return tl::make_unexpected(calibration.error());
  if (auto fits = check_fits(*calibration, plan); !fits) return fail_in(answer, fits.error());
  plan.calibration = std::move(*calibration);
  if (!images_of(plan)) {
    const auto& model = plan.calibration->camera;
    auto error =
        fail(Errc::bad_config,
             fmt::format("{}: it is for images of {}x{}, which this camera does not send: {}",
                         answer, model.width_px, model.height_px, plan.camera.text));
    plan.calibration.reset();
    return error;
  }
  plan.calibration_file = std::filesystem::absolute(answer).lexically_normal();
  return {};
}

Question calibration_question(Plan& plan) {
  return {.flag = "--calibration",
          .text = "Which calibration file do camera and projector have?",
          .options = {},
          .preset = std::string(kNone),
          .take = [&plan](const std::string& answer) { return take_calibration(answer, plan); }};
}

/// The name of the file as that of a rig.
std::string name_of(const std::filesystem::path& file) {
  std::string name;
  for (const char c : file.stem().string().substr(0, 48)) name += is_rig_name({&c, 1}) ? c : '_';
  return name.empty() ? "rig" : name;
}

Question name_question(const Options& options, Plan& plan) {
  return {.flag = "--name",
          .text = "What is the rig called?",
          .options = {},
          .preset = name_of(options.file),
          .take = [&plan](const std::string& answer) -> Result<void> {
            if (!is_rig_name(answer))
              return fail(Errc::bad_config,
                          fmt::format("{} is no name of a rig; {}", quote(answer), kRigNameRule));
            plan.name = answer;
            return {};
          }};
}

/// The controller of the projector that was chosen: one that can be opened before others.
std::optional<Candidate> controller_for(const std::vector<devices::Attached>& attached,
                                        const Candidate& light) {
  const auto controllers = controllers_among(attached);
  if (!light.is_device() || controllers.empty()) return std::nullopt;
  for (const auto& controller : controllers)
    if (controller.device.trouble.empty()) return controller;
  return controllers.front();
}

}  // namespace

std::optional<Images> images_of(const Plan& plan) {
  const auto& modes = plan.camera.device.modes;
  const calib::CameraModel model =
      plan.calibration ? plan.calibration->camera : calib::CameraModel{};
  const Size size{model.width_px, model.height_px};
  if (modes.empty()) return Images{"", size, 0};
  if (!plan.calibration) return recommended(modes);
  return fastest(modes, size);
}

Result<Plan> interview(const std::vector<devices::Attached>& attached, const Options& options,
                       Prompt* prompt) {
  Plan plan;
  const auto& flags = options.flags;
  const auto cameras = cameras_among(attached), lights = lights_among(attached);
  const auto ask_camera = [&] {
    return settle(choice("--camera", "Which camera?", cameras, likely_camera(cameras), plan.camera),
                  flags.camera, prompt);
  };
  const auto ask_light = [&] {
    return settle(
        choice("--output", "Where does the light go?", lights, likely_light(lights), plan.light),
        flags.output, prompt);
  };
  // The twin's hand has its distance and the reference rig its calibration: only flags say
  // otherwise.
  const auto ask_distance = [&] {
    const bool is_lifted = plan.camera.is_device() && plan.tracker == Tracker::none;
    const bool is_asked = is_lifted || flags.distance;
    return is_asked ? settle(distance_question(plan), flags.distance, prompt) : Result<void>();
  };
  const auto ask_calibration = [&] {
    return settle(calibration_question(plan), flags.calibration,
                  plan.camera.is_device() ? prompt : nullptr);
  };
  return ask_camera()
      .and_then(ask_light)
      .and_then([&] { return settle(tracker_question(attached, plan), flags.tracker, prompt); })
      .and_then(ask_distance)
      .and_then(ask_calibration)
      .and_then([&] { return settle(name_question(options, plan), flags.name, prompt); })
      .map([&] {
        plan.controller = controller_for(attached, plan.light);
        return std::move(plan);
      });
}

}  // namespace handcast::init
