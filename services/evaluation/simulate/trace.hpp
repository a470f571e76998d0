// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>

#include "ipc/base/result.hpp"
#include "renderer/pipeline/pipeline.hpp"

namespace handcast::simulate {

/// A CSV file with a line per projector frame and landmark, camera px: what the filters did, for
/// plots.
class Trace {
 public:
  static Result<Trace> open(const std::filesystem::path& file);
  void add(std::int64_t lit_ns, const renderer::FrameHand& hand,
           const std::array<glm::vec2, msg::kLandmarks>& truth);
  /// The last call. Errors: unavailable (the file lacks lines: the disk is full).
  Result<void> close();

 private:
  Trace(std::filesystem::path file, std::ofstream stream)
      : file_(std::move(file)), stream_(std::move(stream)) {}
  std::filesystem::path file_;
  std::ofstream stream_;
};

}  // namespace handcast::simulate
