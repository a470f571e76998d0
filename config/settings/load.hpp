// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/settings/document.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/result.hpp"

namespace handcast::config {

/// Gathers what is wrong with a file, so that a person sees it all at once.
class Faults {
 public:
  void add(std::string sentence) { sentences_.push_back(std::move(sentence)); }
  bool empty() const { return sentences_.empty(); }
  /// The error (bad_config) with a line per fault.
  Error to_error() const;

 private:
  std::vector<std::string> sentences_;
};

/// Writes the values of a document into the settings. What is not mentioned stays as it is; what is
/// wrong becomes a fault "FILE:LINE: path: sentence" and stays as it is too.
void apply_document(const Value& document, std::string_view file, const Listing& listing,
                    Faults& faults);

/// Writes one "path=value", the value typed by its setting: text needs no quotes, a list may go
/// without brackets.
void apply_assignment(std::string_view assignment, const Listing& listing, Faults& faults);

/// " (did you mean 'rate_hz'?)", or nothing where no name is near.
std::string suggest(std::string_view wrong, const std::vector<std::string_view>& known);

}  // namespace handcast::config
