// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/joint_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

namespace handcast::renderer {

JointName parse_joint_name(const std::string& name) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool begins =
        std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]));
    if (begins || !std::isalnum(c)) words.emplace_back();
    if (std::isalnum(c)) words.back() += static_cast<char>(std::tolower(c));
  }
  JointName parsed;
  for (auto& word : words) {
    constexpr std::array<std::string_view, 6> kFillers{"",   "finger", "phalanx",
                                                       "xr", "hand",   "joint"};
    if (word == "l" || word == "left")
      parsed.side = Side::left;
    else if (word == "r" || word == "right")
      parsed.side = Side::right;
    else if (std::ranges::find(kFillers, word) == kFillers.end() &&
             !std::isdigit(static_cast<unsigned char>(word[0]))) {
      if (word == "little") word = "pinky";
      parsed.key += (parsed.key.empty() ? "" : "-") + word;
    }
  }
  return parsed;
}

int joint_of(const std::string& key) {
  static const auto keys = [] {
    std::array<std::string, kJoints> all;
    for (int j = 0; j < kJoints; ++j) all[j] = parse_joint_name(std::string(kJointNames[j])).key;
    return all;
  }();
  const auto found = std::ranges::find(keys, key);
  return found == keys.end() ? -1 : static_cast<int>(found - keys.begin());
}

}  // namespace handcast::renderer
