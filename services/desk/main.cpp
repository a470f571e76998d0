// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/settings/settings.hpp"
#include "ipc/base/home.hpp"
#include "ipc/base/join.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/desk/cues/cue_list.hpp"
#include "services/desk/cues/cues.hpp"
#include "services/desk/gestures.hpp"
#include "services/desk/knobs/gesture_list.hpp"
#include "services/desk/knobs/knobs.hpp"
#include "services/desk/lamp/lamp.hpp"
#include "services/desk/midi/midi.hpp"
#include "services/desk/osc/osc.hpp"
#include "services/desk/page/page.hpp"
#include "services/desk/rig_panel.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/scheduling.hpp"

using namespace handcast;
using service::must;

static constexpr std::int64_t kTurn_ns = 1'000'000'000 / 60;

static desk::Gestures gestures_of(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto& down = rig.content.gravity;
  return {glm::mat4(calibration.camera_from_tracker),
          -glm::vec3(down[0], down[1], down[2]),
          {must(renderer::load_hand_or_default(rig.hand.left, msg::Side::left)),
           must(renderer::load_hand_or_default(rig.hand.right, msg::Side::right))}};
}

/// Everything that people work the rig with. Cues come first: the others work them.
static std::vector<std::unique_ptr<desk::Surface>> open_surfaces(
    const config::Rig& rig, const std::filesystem::path& rig_file,
    const calib::Calibration& calibration, desk::Panel& panel) {
  std::vector<std::unique_ptr<desk::Surface>> surfaces;
  const auto add = [&](std::unique_ptr<desk::Surface> surface) {
    if (surface) surfaces.push_back(std::move(surface));
  };
  const auto remembered = must(state_folder());
  auto cues = must(desk::open_cues(rig, remembered / (rig.name + ".cue"), panel));
  desk::CueDeck* const deck = cues.get();
  add(std::move(cues));
  add(must(desk::open_knobs(rig, panel)));
  add(must(desk::open_lamp(rig, panel)));
  add(must(desk::open_osc(rig, calibration.camera, panel, deck)));
  auto midi = must(desk::open_midi(rig, remembered / (rig.name + ".midi.toml"), panel, deck));
  desk::MidiLearner* const learner = midi.get();
  add(std::move(midi));
  add(must(desk::open_page(rig, {panel, deck, learner, rig_file})));
  return surfaces;
}

/// Opens what people work the rig with, and lets it see the hands until the service ends. At low
/// priority: where cores are short, the desk is late rather than the light.
static void run_desk(service::Context& context) {
  service::give_way();
  const auto& rig = context.filed();
  auto gestures = gestures_of(rig, context.calibration());
  context.stand_by();
  auto board = must(config::LiveBoard::open(rig.name));
  const auto rig_file = board.file();
  desk::RigPanel panel(std::move(board));
  auto surfaces = open_surfaces(rig, rig_file, context.calibration(), panel);
  auto poses = must(context.reader<msg::HandPoses>("pose.hands"));
  context.ready();
  for (std::int64_t due_ns = now_ns(); context.running();) {
    due_ns = std::max(due_ns + kTurn_ns, now_ns());
    sleep_until_ns(due_ns);
    while (poses.await(Deadline::now()))
      if (const auto sample = poses.next(Deadline::now()))
        gestures.push(**sample);
      else
        break;
    const auto& scene = gestures.at(now_ns());
    for (const auto& surface : surfaces) surface->turn(scene);
  }
  // From the last one on: the others work the cues.
  while (!surfaces.empty()) surfaces.pop_back();
}

/// Reads the files that the rig names for the desk. Names the faults of all.
static Result<void> check_desk(const config::Rig& rig, const calib::Calibration&) {
  const auto controls = desk::controls_of(rig);
  std::vector<std::string> faults;
  const auto check = [&](const std::string& file, const auto& read) {
    if (file.empty()) return;
    if (const auto result = read(file, controls); !result) faults.push_back(result.error().what);
  };
  check(rig.desk.cues, desk::cues::read_cues);
  check(rig.desk.gestures, desk::knobs::read_gestures);
  if (faults.empty()) return {};
  return fail(Errc::bad_config, join(faults, "\n"));
}

/// What makes the panel another one, and what the surfaces read.
static std::vector<std::string> settings_read() {
  std::vector<std::string> names{"desk", "hand", "projector.lamp"};
  config::Rig rig;
  for (const auto& section : config::list_settings(rig))
    for (const auto& setting : section.settings)
      if (setting.effect == config::Effect::live) names.push_back(setting.path);
  return names;
}

int main(int argc, char** argv) {
  return service::run({.name = "desk",
                       .summary = "Serves what people work the rig with: a page, OSC, MIDI, cues.",
                       .paced_by = "60 Hz",
                       .subscribes = {"pose.hands"},
                       .settings = settings_read()},
                      argc, argv, run_desk, check_desk);
}
