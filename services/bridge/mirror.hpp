// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace handcast::bridge {

/// Makes the light and the content of this rig follow those of another one. What people change here
/// stays until it is changed there. One thread.
class Mirror {
 public:
  /// What to change here (config::LiveBoard::set()) after the other rig's live values have become
  /// these (msg::LiveSettings::values, of anybody): those of light and content that are other than
  /// before; a name alone is the value of the file again, which may be another one here.
  std::vector<std::string> follow(std::string_view values);

 private:
  std::map<std::string, std::string, std::less<>> theirs_;  ///< by setting, as text
};

}  // namespace handcast::bridge
