// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>

namespace handcast::config {

/// Paths of sections and settings ("twin.motion", "camera.replay"), up to kMost, as a constant
/// expression.
class SettingList {
 public:
  /// More do not compile.
  static constexpr std::size_t kMost = 16;

  constexpr SettingList() = default;
  /// The paths in this order.
  constexpr SettingList(std::initializer_list<std::string_view> paths) {
    for (const std::string_view path : paths) paths_[count_++] = path;
  }
  /// Both lists behind each other.
  constexpr SettingList operator+(const SettingList& others) const {
    SettingList both = *this;
    for (const std::string_view path : others.paths()) both.paths_[both.count_++] = path;
    return both;
  }
  /// The paths; borrows the list.
  constexpr std::span<const std::string_view> paths() const { return {paths_.data(), count_}; }

 private:
  std::array<std::string_view, kMost> paths_{};
  std::size_t count_ = 0;
};

}  // namespace handcast::config
