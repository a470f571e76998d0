// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings/field.hpp"

namespace handcast::config {

/// [SENSOR.external]: the program whose messages the back end `external` takes.
struct External {
  std::vector<std::string> command;
  std::string folder;
  double silent_s = 10;
};

template <class Visitor>
void describe(Visitor& visitor, External& external) {
  visitor.field("command", external.command,
                "The program, which the rig starts, and its arguments: [\"python3\", "
                "\"my_tracker.py\"]. Empty: somebody starts it by hand.");
  visitor.field(
      "folder", external.folder,
      "The folder that it is started in; relative to the rig file. Empty: that of the rig "
      "file.");
  visitor.field("silent_s", external.silent_s, between(0, 3600, "s"),
                "If it sends nothing for so long, it is started again; its first message may take "
                "a minute. 0: never.");
}

inline constexpr std::string_view kOfExternal =
    "For backend = \"external\": a program of your own (docs/operating/your-own-tracker.md).";

/// How long its first message may take: networks are loaded before.
inline double first_message_within_s(const External& external) {
  constexpr double kLoading_s = 60, kEver_s = 1e9;
  return external.silent_s > 0 ? std::max(kLoading_s, external.silent_s) : kEver_s;
}

}  // namespace handcast::config
