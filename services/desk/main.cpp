// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <memory>
#include <optional>
#include <vector>

#include "ipc/base/log.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/desk/gestures.hpp"
#include "services/desk/rig_panel.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using service::must;

static constexpr std::int64_t kTurn_ns = 1'000'000'000 / 60;

static glm::vec3 up_of(const config::Rig& rig) {
  const auto& down = rig.content.gravity;
  return -glm::vec3(down[0], down[1], down[2]);
}

static desk::Gestures gestures_of(const config::Rig& rig, const calib::Calibration& calibration) {
  return {glm::mat4(calibration.camera_from_tracker),
          up_of(rig),
          {must(renderer::load_hand_or_default(rig.hand.left, msg::Side::left)),
           must(renderer::load_hand_or_default(rig.hand.right, msg::Side::right))}};
}

/// Opens what people work the rig with, and lets it see the hands until the service ends. At low
/// priority: where cores are short, the desk is late rather than the light.
static void run_desk(service::Context& context) {
  if (::nice(10) == -1) log::debug("the priority cannot be lowered");
  const auto& rig = context.rig();
  auto gestures = gestures_of(rig, context.calibration());
  context.stand_by();
  desk::RigPanel panel(must(config::LiveBoard::open(rig.name)));
  std::vector<std::unique_ptr<desk::Surface>> surfaces;
  auto poses = must(context.reader<msg::HandPoses>("pose.hands"));
  context.ready();
  for (std::int64_t due_ns = now_ns(); context.running();) {
    due_ns = std::max(due_ns + kTurn_ns, now_ns());
    sleep_until_ns(due_ns);
    while (poses.await(Deadline::now())) {
      const auto sample = poses.next(Deadline::now());
      if (!sample) break;
      gestures.push(**sample);
    }
    const auto& scene = gestures.at(now_ns());
    for (const auto& surface : surfaces) surface->turn(scene);
  }
}

int main(int argc, char** argv) {
  return service::run({.name = "desk",
                       .summary = "Serves what people work the rig with: a page, OSC, MIDI, cues.",
                       .paced_by = "60 Hz",
                       .subscribes = {"pose.hands"},
                       .settings = {"desk", "projector", "light", "content", "hand", "cascade"}},
                      argc, argv, run_desk);
}
