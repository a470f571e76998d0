#pragma once
#include <array>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>

#include "ipc/base/result.hpp"
#include "renderer/pipeline.hpp"

namespace handcast::simulate {

/// A CSV file with a line per projector frame and landmark, camera px: what the filters did, for plots.
class Trace {
 public:
  static Result<Trace> open(const std::filesystem::path& file);
  void add(std::int64_t lit_ns, const renderer::FrameHand& hand, const std::array<glm::vec2, msg::kLandmarks>& truth);

 private:
  explicit Trace(std::ofstream file) : file_(std::move(file)) {}
  std::ofstream file_;
};

}  // namespace handcast::simulate
