// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/settings/document.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/result.hpp"

namespace handcast::config {

/// Collects the errors of a file, so that they are reported together.
class Faults {
 public:
  /// Adds one error.
  void add(std::string sentence) { sentences_.push_back(std::move(sentence)); }
  /// True if there is no error.
  bool empty() const { return sentences_.empty(); }
  /// All errors as one (bad_config), with one line each; of more than 100, the first 100 and the
  /// number of the others.
  Error to_error() const;

 private:
  std::vector<std::string> sentences_;
};

/// Assigns the values of a document to the settings. An invalid value is added to `faults`
/// ("FILE:LINE: path: sentence"), and its setting is not changed.
void apply_document(const Value& document, std::string_view file, const Listing& listing,
                    Faults& faults);

/// Applies one assignment "path=value". The setting determines the type of the value: text needs no
/// quotes, a list needs no brackets. Errors are added to `faults`.
void apply_assignment(std::string_view assignment, const Listing& listing, Faults& faults);

}  // namespace handcast::config
