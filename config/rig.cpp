// SPDX-License-Identifier: Apache-2.0
#include "config/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "config/content_chain.hpp"
#include "config/guests.hpp"
#include "config/keep_out.hpp"
#include "config/live_files.hpp"
#include "config/measured.hpp"
#include "config/opening_hours.hpp"
#include "config/settings/files.hpp"
#include "config/settings/frozen_file.hpp"
#include "config/settings/load.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/home.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/rig_name.hpp"

namespace handcast::config {
namespace {

/// The settings whose values are paths of files or folders.
constexpr std::string_view kPaths[] = {"calibration",
                                       "camera.replay.directory",
                                       "camera.leap.bring_up",
                                       "camera.external.folder",
                                       "camera2.external.folder",
                                       "pose.external.folder",
                                       "landmarks.external.folder",
                                       "landmarks2.external.folder",
                                       "pose.openxr.runtime",
                                       "pose.leapc.library",
                                       "camera2.replay.directory",
                                       "pose.replay.directory",
                                       "landmarks.replay.directory",
                                       "landmarks.models",
                                       "landmarks2.replay.directory",
                                       "landmarks2.models",
                                       "hand.left",
                                       "hand.right",
                                       "content.left",
                                       "content.right",
                                       "desk.cues",
                                       "desk.gestures",
                                       "projector.lamp.password_file",
                                       "projector2.calibration",
                                       "projector2.lamp.password_file",
                                       "desk.page.recordings",
                                       "watch.folder",
                                       "twin.motion",
                                       "twin.shape.mesh",
                                       "twin.geometry.calibration"};

bool is_content(std::string_view setting) { return setting.starts_with("content."); }

/// Makes paths that are relative, or begin with ~, absolute. `where`: of the fault, "rig.toml" or
/// "--set".
void resolve_paths(const Listing& listing, const std::filesystem::path& folder,
                   std::string_view where, Faults& faults) {
  for (const auto path : kPaths) {
    if (is_content(path)) continue;
    auto& text = *std::get<std::string*>(find_setting(listing, path)->target);
    if (!is_path(path, text)) continue;
    auto whole = expand_home(text);
    const auto fault = whole ? fault_of_path(*whole, folder) : whole.error().what;
    if (!fault.empty()) faults.add(fmt::format("{}: {}: {}", where, path, fault));
    text = fault.empty() ? (folder / *whole).lexically_normal().string() : "";
  }
}

/// The program of somebody starts in the folder of the file that names it.
void place_guests(const Listing& listing, const std::filesystem::path& folder) {
  for (const auto& guest : kGuests) {
    const auto setting = [&](const char* name) {
      return find_setting(listing, guest.section() + name);
    };
    auto& place = *std::get<std::string*>(setting(".folder")->target);
    const auto& command = *std::get<std::vector<std::string>*>(setting(".command")->target);
    if (place.empty() && !command.empty()) place = folder.string();
  }
}

/// Checks what is on the hands, and makes the paths in it absolute.
void resolve_contents(const Listing& listing, const std::filesystem::path& folder,
                      std::string_view where, Faults& faults) {
  for (const std::string_view path : {"content.left", "content.right", "content.transition"}) {
    auto& text = *std::get<std::string*>(find_setting(listing, path)->target);
    auto resolved = resolve_content(text, folder);
    if (!resolved) faults.add(fmt::format("{}: {}: {}", where, path, resolved.error().what));
    text = resolved ? std::move(*resolved) : "builtin:white";
  }
}

void check_cores(const Rig& rig, std::string_view file, Faults& faults) {
  for (const auto* service :
       {"camera", "camera2", "pose", "landmarks", "landmarks2", "projector", "projector2", "dlp",
        "content", "desk", "observer", "watch", "bridge"})
    for (const double core : process_of(rig, service).cores)
      if (core != std::floor(core))
        faults.add(fmt::format("{}: {}.process.cores: {} is not the number of a core", file,
                               service, core));
}

void check_currents(const Dlp& dlp, std::string_view file, Faults& faults) {
  const auto check = [&](std::string_view name, double current) {
    if (current > dlp.limit)
      faults.add(
          fmt::format("{}: dlp.{}: {} is above dlp.limit, {}", file, name, current, dlp.limit));
  };
  check("red", dlp.red);
  check("green", dlp.green);
  check("blue", dlp.blue);
}

void check_gravity(const std::vector<double>& gravity, std::string_view file, Faults& faults) {
  const bool is_direction = gravity.size() == 3 && std::ranges::any_of(gravity, [](double part) {
                              return std::abs(part) > 0.01;
                            });
  if (!is_direction)
    faults.add(fmt::format("{}: content.gravity: a direction is needed, as in [0, 1, 0]", file));
}

/// Checks conditions between settings, and those that their ranges do not express.
void check_together(const Rig& rig, std::string_view file, Faults& faults) {
  if (!is_rig_name(rig.name))
    faults.add(fmt::format("{}: name: {} is not a valid name of a rig; {}", file, quote(rig.name),
                           kRigNameRule));
  check_cores(rig, file, faults);
  check_currents(rig.dlp, file, faults);
  check_gravity(rig.content.gravity, file, faults);
  if (const auto areas = parse_keep_out(rig.light.keep_out); !areas)
    faults.add(fmt::format("{}: light.keep_out: {}", file, areas.error().what));
  if (const auto hours = OpeningHours::parse(rig.watch.hours); !hours)
    faults.add(fmt::format("{}: watch.hours: {}", file, hours.error().what));
  const auto& correct = rig.cascade.correct;
  if (correct.bone_short_px >= correct.bone_long_px)
    faults.add(
        fmt::format("{}: cascade.correct.bone_short_px: {} px must be less than "
                    "cascade.correct.bone_long_px, {} px",
                    file, correct.bone_short_px, correct.bone_long_px));
}

/// What a file is that was taken for a rig file; "" if it may be one.
std::string_view other_kind(const Table& document) {
  for (const auto& [name, value] : document) {
    if (name == "rig" || name == "variant")
      return "is a plan, not a rig file; `handcast sweep` takes it, and checks it with --list";
    const auto* members = std::get_if<Table>(&value.data);
    if (name == "camera" && members &&
        std::ranges::find(*members, "width_px", &Member::name) != members->end())
      return "is a calibration, not a rig file, which names one as `calibration`";
  }
  return {};
}

/// The values of the last text win over those of the others and of `rig`, and `settings` over all.
/// The first text is named by faults between settings.
Result<Rig> parse_layers(Rig rig, std::span<const NamedText> layers,
                         const std::vector<std::string>& settings) {
  const auto listing = list_settings(rig);
  Faults faults;
  // The folder that this process was started in may have been deleted since: what is relative to it
  // then stays so, and is not found.
  std::error_code gone;
  for (const auto& [file, toml] : layers) {
    const auto document = parse_document(toml, file);
    if (!document) return tl::make_unexpected(document.error());
    if (const auto kind = other_kind(std::get<Table>(document->data)); !kind.empty())
      return fail(Errc::bad_config, fmt::format("{} {}", file, kind));
    apply_document(*document, file, listing, faults);
    const auto folder = std::filesystem::absolute(file, gone).parent_path();
    resolve_paths(listing, folder, file, faults);
    resolve_contents(listing, folder, file, faults);
    place_guests(listing, folder);
  }
  for (const auto& setting : settings) apply_assignment(setting, listing, faults);
  const auto here = std::filesystem::current_path(gone);
  resolve_paths(listing, here, "--set", faults);
  resolve_contents(listing, here, "--set", faults);
  place_guests(listing, here);
  check_together(rig, layers.front().path, faults);
  if (!faults.empty()) return tl::make_unexpected(faults.to_error());
  return rig;
}

}  // namespace

bool names_a_file(std::string_view setting) {
  return std::ranges::find(kPaths, setting) != std::end(kPaths);
}

bool is_path(std::string_view setting, std::string_view value) {
  if (!names_a_file(setting) || value.empty()) return false;
  if (setting == "twin.shape.mesh" && value.find_first_of("./") == value.npos) return false;
  if (is_content(setting)) {
    const auto chain = parse_content(value);
    return chain && is_still(*chain) && is_content_file(chain->front());
  }
  return !value.starts_with("builtin:") && !value.starts_with(kFrozen);
}

/// The name at a viewpoint, if it begins with one of these words.
static std::string numbered(Viewpoint at, std::string_view name,
                            std::initializer_list<std::string_view> words) {
  for (const auto word : words)
    if (at == Viewpoint::second && name.substr(0, name.find('.')) == word)
      return std::string(word) + "2" + std::string(name.substr(word.size()));
  return std::string(name);
}

std::string name_at(Viewpoint at, std::string_view name) {
  return numbered(at, name, {"camera", "landmarks"});
}

std::string name_at_projector(Viewpoint at, std::string_view name) {
  return numbered(at, name, {"projector", "projection"});
}

std::string name_at_first(std::string_view name) {
  for (const std::string first : {"camera", "landmarks", "projector", "projection"})
    if (const auto word = name.substr(0, name.find('.')); word == first + "2")
      return first + std::string(name.substr(word.size()));
  return {};
}

const Camera& camera_at(const Rig& rig, Viewpoint at) {
  return at == Viewpoint::first ? rig.camera : rig.camera2;
}

Rig rig_at_projector(Rig rig, Viewpoint at) {
  if (at == Viewpoint::second) rig.projector = rig.projector2;
  return rig;
}

const Landmarks& landmarks_at(const Rig& rig, Viewpoint at) {
  return at == Viewpoint::first ? rig.landmarks : rig.landmarks2;
}

static const Process* find_process(const Rig& rig, std::string_view service) {
  if (service == "camera") return &rig.camera.process;
  if (service == "camera2") return &rig.camera2.process;
  if (service == "pose") return &rig.pose.process;
  if (service == "landmarks") return &rig.landmarks.process;
  if (service == "landmarks2") return &rig.landmarks2.process;
  if (service == "projector") return &rig.projector.process;
  if (service == "projector2") return &rig.projector2.process;
  if (service == "dlp") return &rig.dlp.process;
  if (service == "content") return &rig.content.process;
  if (service == "desk") return &rig.desk.process;
  if (service == "observer") return &rig.observer.process;
  if (service == "watch") return &rig.watch.process;
  if (service == "bridge") return &rig.bridge.process;
  return nullptr;
}

Process process_of(const Rig& rig, std::string_view service) {
  for (const auto& guest : kGuests)
    if (service == guest.service) return process_of(rig, guest.feeds);
  const auto* process = find_process(rig, service);
  return process ? *process : Process();
}

bool has_process(std::string_view service) { return find_process(Rig(), service) != nullptr; }

Result<Rig> parse_rig(const std::string& toml, const std::filesystem::path& file,
                      const std::vector<std::string>& settings) {
  const NamedText whole{file.string(), toml};
  return parse_layers({}, {&whole, 1}, settings);
}

Result<Rig> change_rig(const Rig& rig, const NamedText& layer,
                       const std::vector<std::string>& settings) {
  return parse_layers(rig, {&layer, 1}, settings);
}

/// Names the rig that was installed under the name of a file that is not there.
static Error with_installed(Error error, const std::filesystem::path& file) {
  std::error_code unknown;
  const auto installed = share_folder() / "rigs" / file.filename();
  if (!std::filesystem::exists(file, unknown) &&
      std::filesystem::is_regular_file(installed, unknown))
    error.what += "; there is " + installed.string();
  return error;
}

Result<Rig> load_rig(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  std::vector<NamedText> layers;
  std::error_code unknown;
  for (const auto& layer : {file, measured_file_of(file), live_file_of(file)}) {
    if (!layers.empty() && !std::filesystem::exists(layer, unknown)) continue;
    auto text = read_text(layer);
    if (!text) return tl::make_unexpected(with_installed(text.error(), layer));
    layers.push_back({layer.string(), std::move(*text)});
  }
  return parse_layers({}, layers, settings);
}

std::string print_rig(const Rig& rig) {
  auto copy = rig;
  return print_settings(list_settings(copy), "All settings of this rig.");
}

}  // namespace handcast::config
