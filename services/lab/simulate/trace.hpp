// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>

#include "ipc/base/result.hpp"
#include "renderer/pipeline/pipeline.hpp"

namespace handcast::simulate {

/// A CSV file with the true, the tracker's and the corrected landmarks, for plots of the filters: a
/// line per projector frame and landmark, in camera px.
class Trace {
 public:
  /// Creates the file and writes the header line. Errors: bad_config (it cannot be written).
  static Result<Trace> open(const std::filesystem::path& file);
  /// Writes the lines of one hand whose light is on at `display_ns`.
  void add(std::int64_t display_ns, const renderer::FrameHand& hand,
           const std::array<glm::vec2, msg::kLandmarks>& truth);
  /// Closes the file; must be the last call. Errors: unavailable (lines are missing, e.g. because
  /// the disk is full).
  Result<void> close();

 private:
  Trace(std::filesystem::path file, std::ofstream stream)
      : file_(std::move(file)), stream_(std::move(stream)) {}
  std::filesystem::path file_;
  std::ofstream stream_;
};

}  // namespace handcast::simulate
