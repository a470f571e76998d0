// SPDX-License-Identifier: Apache-2.0
#include "services/desk/knobs/knobs.hpp"

#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "services/desk/controls/complaints.hpp"
#include "services/desk/controls/control_value.hpp"
#include "services/desk/controls/file_watch.hpp"
#include "services/desk/knobs/turner.hpp"

namespace handcast::desk {
namespace knobs {
namespace {

constexpr std::int64_t kPause_ns = 1'000'000'000 / 30;
constexpr const char* kSource = "gestures";

class Knobs final : public Surface {
 public:
  Knobs(std::string file, const std::vector<GestureKnob>& knobs, Panel& panel)
      : file_(std::move(file)), watch_(file_), panel_(panel) {
    take(knobs);
  }

  void turn(const Scene& scene) override {
    if (watch_.has_changed(scene.now_ns)) read_again(scene.now_ns);
    if (scene.now_ns - turned_ns_ < kPause_ns) return;
    const double step_s = turned_ns_ == 0 ? 0 : ns_to_seconds(scene.now_ns - turned_ns_);
    turned_ns_ = scene.now_ns;
    const auto values = panel_.values();
    bool changes = false;
    for (auto& turner : turners_) {
      const auto control = turner.knob().control;
      const auto value = number_of(panel_.controls()[control], values->toml[control]);
      if (value && turner.turn(scene, step_s, *value)) changes = true;
    }
    if (changes) set_all(scene.now_ns);
  }

 private:
  void take(const std::vector<GestureKnob>& knobs) {
    turners_.clear();
    for (const auto& knob : knobs) turners_.emplace_back(knob);
  }

  void read_again(std::int64_t now_ns) {
    const auto knobs = read_gestures(file_, panel_.controls());
    if (!knobs)
      return complaints_.add(now_ns, knobs.error().what + "; the gestures stay as they are");
    take(*knobs);
    log::info("{} was read again", file_);
  }

  /// Sets all that hands turn now, so that a hand's way is one change for `undo`.
  void set_all(std::int64_t now_ns) {
    std::vector<std::string> assignments;
    for (const auto& turner : turners_) {
      if (!turner.wanted()) continue;
      const auto assignment =
          assign_number(panel_.controls()[turner.knob().control], *turner.wanted());
      if (!assignment) return complaints_.add(now_ns, assignment.error().what);
      assignments.push_back(*assignment);
    }
    if (const auto set = panel_.set(assignments, kSource); !set)
      return complaints_.add(now_ns, set.error().what);
    for (auto& turner : turners_)
      if (turner.wanted()) turner.was_set();
  }

  std::string file_;
  FileWatch watch_;
  Panel& panel_;
  Complaints complaints_{"gestures"};
  std::vector<Turner> turners_;
  std::int64_t turned_ns_ = 0;
};

}  // namespace
}  // namespace knobs

Result<std::unique_ptr<Surface>> open_knobs(const config::Rig& rig, Panel& panel) {
  const auto& file = rig.desk.gestures;
  if (file.empty()) return nullptr;
  const auto read = knobs::read_gestures(file, panel.controls());
  if (!read) return tl::make_unexpected(read.error());
  return std::make_unique<knobs::Knobs>(file, *read, panel);
}

}  // namespace handcast::desk
