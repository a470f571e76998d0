// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings/document.hpp"

namespace handcast::config {

/// A value for a setting: "landmarks.backend" = "own".
struct Assignment {
  std::string setting;  ///< its whole path
  std::string value;    ///< text without quotes

  /// Compares both members.
  bool operator==(const Assignment&) const = default;
};

/// A setting, or one word of a setting, that has been renamed. Old files remain valid: the loader
/// reads the old form as the new one and reports it.
///
///     {{"landmarks.backend", "own"}, {"landmarks.backend", "handcast"}}    one word of a setting
///     {{"camera.fps"}, {"camera.rate_hz"}}                                 a setting, any value
struct Renamed {
  /// A setting with one value, or with any value.
  struct Form {
    std::string_view setting;     ///< its whole path
    std::string_view value = {};  ///< empty: any value, which does not change
  };
  /// The old and the present form.
  /// @{
  Form old, now;
  /// @}
  Form also = {};  ///< a second setting that the old word implied; empty: none
};

/// Called with one sentence for each use of an old form:
/// "rig.toml:12: landmarks.backend = "own" is now "handcast"".
using OnRenamed = std::function<void(const std::string& sentence)>;

/// The present form of `assignment`: the assignment itself if it is not in `table`. `where`: the
/// beginning of the sentence, "rig.toml:12".
std::vector<Assignment> current_form(const Assignment& assignment, std::string_view where,
                                     std::span<const Renamed> table, const OnRenamed& on_renamed);

/// Replaces the old forms in a document. A setting that the document also has in its new form keeps
/// the value of the new form.
void replace_renamed(Value& document, std::string_view file, std::span<const Renamed> table,
                     const OnRenamed& on_renamed);

/// The same for "path=value" (see apply_assignment()). The sentences begin with "--set". A text
/// that is not an assignment is returned unchanged.
std::vector<std::string> replace_renamed(const std::string& assignment,
                                         std::span<const Renamed> table,
                                         const OnRenamed& on_renamed);

}  // namespace handcast::config
