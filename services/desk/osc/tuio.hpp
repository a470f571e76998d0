// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk::osc {

/// The finger tips as TUIO 1.1 cursors (tuio.org/?specification, profile /tuio/2Dcur): 0..1 from
/// left to right and from top to bottom of the camera's image. One thread.
class Tuio {
 public:
  explicit Tuio(const calib::CameraModel& camera) : camera_(camera) {}

  /// The bundle of this turn: source, alive, set (of each finger tip), fseq. Without fingers one a
  /// second; "" between.
  std::string bundle(const Scene& scene);

 private:
  static constexpr std::size_t kTips = 5;
  /// A finger tip.
  struct Cursor {
    std::int32_t id = 0;          ///< counted up: a finger that comes back has another one
    glm::dvec2 place{}, speed{};  ///< 0..1; per second
    double acceleration = 0;      ///< of the amount of the speed, per second squared
    std::int64_t time_ns = 0;
  };
  void move(std::optional<Cursor>& cursor, glm::dvec2 place, std::int64_t now_ns);

  calib::CameraModel camera_;
  std::array<std::array<std::optional<Cursor>, kTips>, msg::kMaxHands> cursors_;
  std::int32_t last_id_ = 0, frame_ = 0;
  std::int64_t due_ns_ = 0;  ///< when an empty bundle is sent again
  bool was_alive_ = false;
};

}  // namespace handcast::desk::osc
