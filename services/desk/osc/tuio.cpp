// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/tuio.hpp"

#include "ipc/base/clock.hpp"
#include "services/desk/osc/packet.hpp"

namespace handcast::desk::osc {
namespace {

constexpr std::string_view kCursors = "/tuio/2Dcur";
constexpr std::array<std::size_t, 5> kTipJoints{5, 10, 15, 20, 25};  ///< of XR_EXT_hand_tracking
constexpr std::int64_t kIdlePeriod_ns = 1'000'000'000;

/// Where a joint is in the image, 0..1; empty if it is outside.
std::optional<glm::dvec2> place_of(const calib::CameraModel& camera, glm::vec3 joint_m) {
  if (!(joint_m.z > 0)) return std::nullopt;
  const auto pixel = camera.project(glm::dvec3(joint_m));
  const glm::dvec2 place = (pixel + 0.5) / glm::dvec2(camera.width_px, camera.height_px);
  const bool is_inside = place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1;
  return is_inside ? std::optional(place) : std::nullopt;
}

}  // namespace

void Tuio::move(std::optional<Cursor>& cursor, glm::dvec2 place, std::int64_t now_ns) {
  if (!cursor) {
    cursor = Cursor{.id = ++last_id_, .place = place, .time_ns = now_ns};
    return;
  }
  const double passed_s = ns_to_seconds(now_ns - cursor->time_ns);
  if (passed_s <= 0) return;
  const auto speed = (place - cursor->place) / passed_s;
  cursor->acceleration = (glm::length(speed) - glm::length(cursor->speed)) / passed_s;
  cursor->speed = speed;
  cursor->place = place;
  cursor->time_ns = now_ns;
}

std::string Tuio::bundle(const Scene& scene) {
  MessageWriter alive(kCursors);
  alive.add("alive");
  std::vector<std::string> sets;
  for (std::size_t side = 0; side < cursors_.size(); ++side)
    for (std::size_t tip = 0; tip < kTips; ++tip) {
      auto& cursor = cursors_[side][tip];
      const auto place = scene.gestures[side].is_there
                             ? place_of(camera_, scene.joints_m[side][kTipJoints[tip]])
                             : std::nullopt;
      if (!place) {
        cursor.reset();
        continue;
      }
      move(cursor, *place, scene.now_ns);
      alive.add(cursor->id);
      MessageWriter set(kCursors);
      set.add("set").add(cursor->id);
      for (const double number : {cursor->place.x, cursor->place.y, cursor->speed.x,
                                  cursor->speed.y, cursor->acceleration})
        set.add(static_cast<float>(number));
      sets.push_back(set.packet());
    }
  if (sets.empty() && !was_alive_ && scene.now_ns < due_ns_) return "";
  was_alive_ = !sets.empty();
  due_ns_ = scene.now_ns + kIdlePeriod_ns;
  std::vector<std::string> messages{MessageWriter(kCursors).add("source").add("handcast").packet(),
                                    alive.packet()};
  messages.insert(messages.end(), sets.begin(), sets.end());
  messages.push_back(MessageWriter(kCursors).add("fseq").add(++frame_).packet());
  return write_bundle(messages);
}

}  // namespace handcast::desk::osc
