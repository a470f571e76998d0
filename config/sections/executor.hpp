// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

namespace handcast::config {

/// The library that runs a detector's neural networks.
enum class Executor {
  onednn,  ///< handcast's executor, on oneDNN's primitives
  opencv,  ///< OpenCV's dnn module
};
constexpr std::array<std::string_view, 2> words_of(Executor) { return {"onednn", "opencv"}; }

}  // namespace handcast::config
