// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "config/measured.hpp"
#include "config/second_view.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/program.hpp"
#include "ipc/daemon/description.hpp"
#include "services/desk/cues/cue_list.hpp"
#include "services/desk/page/json_text.hpp"

namespace handcast::desk {
namespace {

using nlohmann::json;

constexpr std::size_t kMostTargets = 4;  ///< of a cue, in words

/// Whether a shader is one that is laid over others, or leads from one to another.
bool is_no_look(const std::string& text) {
  return text.find(R"("CATEGORIES": ["Filter")") != std::string::npos ||
         text.find(R"("CATEGORIES": ["Transition")") != std::string::npos;
}

std::filesystem::path looks_folder() { return assets_folder() / "looks"; }

std::filesystem::path picture_file(const std::filesystem::path& look) {
  return std::filesystem::path(look).replace_extension(".png");
}

json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

/// 75600: "21:00".
std::string time_of_day(double seconds) {
  const auto all = static_cast<int>(seconds);
  const auto text = fmt::format("{}:{:02}", all / 3600, all / 60 % 60);
  return all % 60 == 0 ? text : text + fmt::format(":{:02}", all % 60);
}

std::string words_of(const cues::Trigger& trigger) {
  using Kind = cues::Trigger::Kind;
  switch (trigger.kind) {
    case Kind::key:
      return "key " + trigger.name;
    case Kind::at:
      return "at " + time_of_day(trigger.seconds);
    case Kind::idle:
      return fmt::format("no hand for {:g} s", trigger.seconds);
    case Kind::after:
      return fmt::format("{:g} s after the one before", trigger.seconds);
    default:
      return trigger.name;
  }
}

/// content.transition="isf:wipe.fs": `content.transition → isf:wipe.fs`.
std::string words_of(std::string assignment) {
  if (const auto at = assignment.find('='); at != assignment.npos)
    assignment.replace(at, 1, " \u2192 ");
  std::erase(assignment, '"');
  return assignment;
}

std::string words_of(const cues::Target& target, std::span<const Control> controls) {
  if (target.numbers.empty() || target.control >= controls.size())
    return words_of(target.assignment);
  constexpr std::array kCurves{"", ", slow at the end", ", slow at both ends"};
  auto value =
      fmt::format("{} \u2192 {:g}", controls[target.control].path, fmt::join(target.numbers, ", "));
  if (target.fade_s <= 0) return value;
  return value + fmt::format(" in {:g} s{}", target.fade_s,
                             kCurves[static_cast<std::size_t>(target.curve)]);
}

std::string what_it_does(const cues::Cue& cue, std::span<const Control> controls) {
  std::vector<std::string> parts;
  for (const auto& [hand, content] : cue.content) {
    // A file of a show is known by its name.
    const auto slash = content.rfind('/');
    parts.push_back(hand + ": " + (slash == content.npos ? content : content.substr(slash + 1)));
  }
  for (const auto& target : cue.targets) parts.push_back(words_of(target, controls));
  if (parts.size() > kMostTargets + 1) {
    const auto more = parts.size() - kMostTargets;
    parts.resize(kMostTargets);
    parts.push_back(fmt::format("{} more", more));
  }
  return join(parts, "; ");
}

/// The setting that the step `light` measures; "" if it was not.
std::string measured_light(const std::filesystem::path& rig_file) {
  const auto measured = rig_file.empty()
                            ? Result<std::vector<config::MeasuredSetting>>()
                            : config::read_measured(config::measured_file_of(rig_file));
  if (!measured) return "";
  const auto found =
      std::ranges::find(*measured, "projector.latency_ms", &config::MeasuredSetting::path);
  return found == measured->end() ? "" : fmt::format("after {} ms", found->value);
}

json age_days(const std::filesystem::path& file) {
  std::error_code absent;
  const auto written = std::filesystem::last_write_time(file, absent);
  if (file.empty() || absent) return {};
  const std::chrono::duration<double> age = std::filesystem::file_time_type::clock::now() - written;
  return std::floor(age.count() / 86'400);
}

}  // namespace

std::string calibration_facts(const config::Rig& rig, const std::filesystem::path& rig_file,
                              const calib::Calibration& calibration) {
  struct Step {
    const char *name, *what;
    std::string made;
    bool is_wanted;
  };
  const auto& made = calibration.made;
  const bool has_second = config::has_second_view(rig);
  auto steps = json::array();
  for (const auto& step : {Step{"lens", "The camera's lens", made.lens, true},
                           Step{"lens2", "The second camera's lens", made.lens2, has_second},
                           Step{"pair", "Where the second camera is", made.pair, has_second},
                           Step{"screen", "The projector", made.screen, true},
                           Step{"tracker", "Where the tracker is", made.tracker, true},
                           Step{"light", "When the light comes", measured_light(rig_file), true}})
    if (step.is_wanted)
      steps.push_back(
          {{"step", step.name},
           {"what", step.what},
           {"made", step.made},
           {"command", fmt::format("handcast calibrate {} {}",
                                   rig_file.empty() ? "RIG.toml" : rig_file.string(), step.name)}});
  return json_text({{"file", rig.calibration},
                    {"age_days", age_days(rig.calibration)},
                    {"steps", std::move(steps)}});
}

std::string cue_facts(const std::filesystem::path& file, std::span<const Control> controls) {
  auto all = json::array();
  const auto list = file.empty() ? Result<cues::CueList>() : cues::read_cues(file, controls);
  for (const auto& cue : list ? list->cues : std::vector<cues::Cue>()) {
    std::vector<std::string> triggers;
    for (const auto& trigger : cue.triggers) triggers.push_back(words_of(trigger));
    all.push_back({{"on", join(triggers, ", ")}, {"does", what_it_does(cue, controls)}});
  }
  return json_text(all);
}

json looks() {
  std::vector<std::string> names;
  const auto folder = looks_folder();
  std::error_code absent;
  for (const auto& file : std::filesystem::directory_iterator(folder, absent)) {
    const auto& path = file.path();
    if (path.extension() == ".fs" && !is_no_look(read_input(path, kMostText).value_or("")))
      names.push_back(path.stem().string());
  }
  std::ranges::sort(names);
  auto all = json::array();
  for (const auto& name : names)
    all.push_back({{"name", name},
                   {"picture", std::filesystem::exists(picture_file(folder / name), absent)}});
  return all;
}

std::optional<std::string> picture_of_look(std::string_view look) {
  // A name, not a path: nothing else of this computer is sent.
  if (look.empty() || look.find_first_of("/\\.") != look.npos) return std::nullopt;
  auto picture = read_input(picture_file(looks_folder() / look), kMostText);
  return picture ? std::optional(std::move(*picture)) : std::nullopt;
}

json backends() {
  auto all = json::object();
  std::error_code absent;
  for (const auto& file :
       std::filesystem::directory_iterator(share_folder() / "services", absent)) {
    const auto text = read_input(file.path(), kMostText);
    const auto service = text ? daemon::parse_description(*text)
                              : Result<daemon::ServiceDescription>(fail(Errc::bad_data, ""));
    if (!service) continue;
    auto& list = all[service->name] = json::array();
    for (const auto& backend : service->backends)
      list.push_back({{"name", backend.name}, {"sentence", backend.sentence}});
  }
  return all;
}

json json_of(const Control& control) {
  constexpr std::array kKinds{"toggle", "whole", "number", "text", "choice", "numbers", "texts"};
  return {{"path", control.path},
          {"kind", kKinds[static_cast<std::size_t>(control.kind)]},
          {"min", number_or_null(control.range.min)},
          {"max", number_or_null(control.range.max)},
          {"unit", control.range.unit},
          {"words", control.words},
          {"sentence", control.sentence},
          {"initial", control.initial},
          {"filed", control.filed}};
}

}  // namespace handcast::desk
