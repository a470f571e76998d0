// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/sections/process.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [watch.black_box]
struct BlackBox {
  double seconds = 30;
  int kept = 10;
  bool images = false;
};

template <class Visitor>
void describe(Visitor& visitor, BlackBox& box) {
  visitor.field("seconds", box.seconds, between(0, 120, "s"),
                "How much of the time before a fault is kept. 0: nothing.");
  visitor.field("kept", box.kept, between(1, 1000),
                "The number of black boxes; the oldest is removed for a new one.");
  visitor.field("images", box.images,
                "Also keep five images of the camera a second. They show people: ask them.");
}

/// [watch.alert]
struct Alert {
  std::vector<std::string> command;
  bool starts = false;
  double again_s = 3600;
  double silent_s = 10;
  double disk_gb = 2;
  double well_s = 60;
};

template <class Visitor>
void describe(Visitor& visitor, Alert& alert) {
  visitor.field("command", alert.command,
                "The program that is told of a fault and of its end, and its arguments; the text "
                "is its standard input: [\"mail\", \"-s\", \"handcast\", \"me@example.org\"]. "
                "Empty: nobody is told.");
  visitor.field("starts", alert.starts,
                "Also tell of each start of the rig. It shows that the program works.");
  visitor.field("again_s", alert.again_s, between(0, 1e6, "s"),
                "The shortest time between two alerts of one kind.");
  visitor.field("silent_s", alert.silent_s, between(1, 3600, "s"),
                "A sensor that sends nothing for so long, and a projector without frames, are "
                "faults.");
  visitor.field("disk_gb", alert.disk_gb, between(0, 1e5, "GB"),
                "A disk with less space than this, where the reports are, is a fault.");
  visitor.field("well_s", alert.well_s, between(0, 3600, "s"),
                "A fault is over when it has not been seen for so long.");
}

/// [watch]
struct Watch {
  bool enabled = false;
  std::vector<std::string> hours;
  std::vector<std::string> opening, closing;
  double command_s = 20;
  std::string folder;
  int days = 90;
  Alert alert;
  BlackBox black_box;
  Process process{.wait = ipc::Wait::futex};
};

template <class Visitor>
void describe(Visitor& visitor, Watch& watch) {
  visitor.field("enabled", watch.enabled,
                "Watch the rig: opening hours, daily reports, alerts, black boxes.");
  visitor.field("hours", watch.hours,
                "When there is light, in local time: [\"mon-fri 10:00-18:00\", \"sat,sun "
                "10:00-20:00\", \"2026-12-24 closed\", \"12-31 10:00-14:00\"]. A date, of one year "
                "or of each, goes before days. Empty: always.");
  visitor.field("opening", watch.opening,
                "A program, and its arguments, that is started when the light comes on.");
  visitor.field("closing", watch.closing, "The same when it goes off.");
  visitor.field("command_s", watch.command_s, between(1, 600, "s"),
                "A program that takes longer, also that of an alert, is killed.");
  visitor.field("folder", watch.folder,
                "The folder of reports and black boxes. Empty: RIG.watch/ beside the rig file.");
  visitor.field("days", watch.days, between(1, 3650), "The number of days that are kept.");
  visitor.section("alert", watch.alert, "Who is told of faults.");
  visitor.section("black_box", watch.black_box, "What is kept of the time before a fault.");
  visitor.section("process", watch.process, "The process of the service.");
}

}  // namespace handcast::config
