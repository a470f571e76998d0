// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "config/settings/field.hpp"

namespace handcast::config {

/// A fault that begins at one time and lasts for a while. Times are since the epoch of the rig, at
/// which the twin's motion starts.
struct Fault {
  double at_s = 0;       ///< when it begins
  double lasting_s = 0;  ///< how long it lasts; 0: it never happens

  bool operator==(const Fault&) const = default;
  /// True if the fault is present at this time.
  constexpr bool holds(double seconds) const {
    return seconds >= at_s && seconds < at_s + lasting_s;
  }
};

/// Declares the two settings of a fault; `sentence` describes its effect.
template <class Visitor>
void describe_fault(Visitor& visitor, Fault& fault, std::string_view at_name,
                    std::string_view lasting_name, std::string_view sentence) {
  visitor.field(at_name, fault.at_s, between(0, 1e6, "s"),
                "Fault: its begin, since the start of the rig; the next setting says what it is.");
  visitor.field(lasting_name, fault.lasting_s, between(0, 1e6, "s"), sentence);
}

}  // namespace handcast::config
