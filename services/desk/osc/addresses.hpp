// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "services/desk/base/panel.hpp"
#include "services/desk/osc/packet.hpp"

namespace handcast::desk::osc {

/// The address of a setting: "/projector/brightness" for "projector.brightness".
std::string address_of(std::string_view path);

/// The addresses of the live settings. Constant.
class Addresses {
 public:
  /// `controls` must outlive this object.
  explicit Addresses(std::span<const Control> controls);

  std::span<const Control> controls() const { return controls_; }
  /// The control at an address; empty if there is none.
  std::optional<std::size_t> find(std::string_view address) const;
  /// The controls whose addresses a pattern stands for: see matches().
  std::vector<std::size_t> find_all(std::string_view pattern, int& steps) const;

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const {
      return std::hash<std::string_view>()(text);
    }
  };
  std::span<const Control> controls_;
  std::vector<std::string> addresses_;  ///< by control
  std::unordered_map<std::string, std::size_t, Hash, std::equal_to<>> index_;
};

/// The assignment "path=value" that a message makes; nil (N) sets the value of the rig file.
/// Errors: bad_data (its arguments are none of the control's values).
Result<std::string> assignment_of(const Control& control, const Message& message);

/// The message that says the value of a control, as in Values::toml: "/light/blackout ,T".
std::string write_value(const Control& control, std::string_view toml);

}  // namespace handcast::desk::osc
