// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/live/live_board.hpp"
#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

struct handcast_content;

namespace handcast::study {

/// A hand of a rig that is up, as a program sees it that draws on it: by the interface for other
/// people's programs (handcast.h). The rig shows the program's pictures from the first one on, and
/// what it showed before when this object is gone; if the program dies, its last picture stays.
/// One thread.
class RigHand {
 public:
  /// `rig`: its name; "": the only one that is up. `program`: who changes settings, for the log.
  /// Errors: unavailable (no rig is up, or another program draws), bad_config.
  static Result<RigHand> open(const std::string& rig, msg::Side side, int width_px, int height_px,
                              const std::string& program);
  RigHand(RigHand&&) noexcept;
  ~RigHand();

  /// The mesh that the rig draws for it. Errors: those of renderer::load_hand_or_default().
  Result<renderer::HandMesh> mesh() const;
  /// Waits for a new sample of the tracker, at most 100 ms. Errors: disconnected (the rig is down).
  Result<void> wait();
  using Joints = std::array<glm::vec3, msg::kJoints>;
  /// The joints in the newest sample, tracker space, m; empty if the hand is not seen.
  const std::optional<Joints>& joints() const { return joints_; }
  /// Shows a picture of the size of this object, RGBA8. One that comes while the rig still reads
  /// the last ones is left out. Errors: disconnected.
  Result<void> show(renderer::View<const std::uint32_t> picture);
  /// Changes live settings, "path=value", or "path" for the value of the rig file. They are taken
  /// back at the end. Errors: those of LiveBoard::set().
  Result<void> set(const std::vector<std::string>& assignments);

 private:
  struct Close {
    void operator()(handcast_content* content) const;
  };
  RigHand(std::unique_ptr<handcast_content, Close> content, config::LiveBoard board, msg::Side side,
          std::string program)
      : content_(std::move(content)),
        board_(std::move(board)),
        side_(side),
        program_(std::move(program)) {}

  std::unique_ptr<handcast_content, Close> content_;
  std::optional<config::LiveBoard> board_;
  msg::Side side_;
  std::string program_;
  std::optional<Joints> joints_;
  bool is_shown_ = false;                ///< the rig shows these pictures
  std::vector<std::string> afterwards_;  ///< assignments that take back what was set
};

}  // namespace handcast::study
