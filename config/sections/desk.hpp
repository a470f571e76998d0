// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/sections/process.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [desk.osc]
struct DeskOsc {
  std::string listen;
  std::vector<std::string> send;
  std::vector<std::string> tuio;
  double rate_hz = 60;
  int query_port = 0;
};

template <class Visitor>
void describe(Visitor& visitor, DeskOsc& osc) {
  visitor.field("listen", osc.listen,
                "Where OSC messages are taken by UDP, e.g. \"127.0.0.1:9000\"; \"0.0.0.0:9000\": "
                "from every computer of the network. Empty: nowhere.");
  visitor.field("send", osc.send,
                "Where joints, gestures and changes are sent, e.g. [\"127.0.0.1:9001\"].");
  visitor.field("tuio", osc.tuio,
                "Where the finger tips are sent by TUIO 1.1 as cursors (/tuio/2Dcur), e.g. "
                "[\"127.0.0.1:3333\"].");
  visitor.field("rate_hz", osc.rate_hz, between(1, 240, "Hz"), "How often joints are sent.");
  visitor.field("query_port", osc.query_port, between(0, 65535),
                "The TCP port at which OSCQuery describes the addresses, on the address of "
                "`listen`. 0: nowhere.");
}

/// [desk.midi]
struct DeskMidi {
  std::string device;
};

template <class Visitor>
void describe(Visitor& visitor, DeskMidi& midi) {
  visitor.field("device", midi.device,
                "The MIDI controller: a part of its name, or \"jack:\" and a part of the name that "
                "JACK gives it. If there is none, the log lists those that there are, and it is "
                "looked for every second. Empty: none.");
}

/// [desk.page]
struct DeskPage {
  std::string listen = "127.0.0.1:8480";
  std::string lan;
  std::string recordings;
};

template <class Visitor>
void describe(Visitor& visitor, DeskPage& page) {
  visitor.field("listen", page.listen,
                "Where the page is served, on this computer; if the port is taken, at a free one "
                "(`handcast desk` prints the address). Empty: nowhere.");
  visitor.field("lan", page.lan,
                "Where the page is also served to phones and other computers, encrypted, e.g. "
                "\"0.0.0.0:8481\": to all that reach this one (`handcast desk --lan` prints the "
                "address and a code). Empty: nowhere.");
  visitor.field(
      "recordings", page.recordings,
      "The folder of the recordings that the page lists and makes. Empty: recordings/ beside "
      "the rig file.");
}

/// [desk]
struct Desk {
  std::string cues;
  std::string gestures;
  DeskOsc osc;
  DeskMidi midi;
  DeskPage page;
  Process process{.wait = ipc::Wait::futex};
};

template <class Visitor>
void describe(Visitor& visitor, Desk& desk) {
  visitor.field("cues", desk.cues, "The cue list, a TOML file. Empty: none.");
  visitor.field("gestures", desk.gestures,
                "The settings that hands turn, a TOML file with [[gesture]]. Empty: none.");
  visitor.section("osc", desk.osc, "OSC in and out.");
  visitor.section("midi", desk.midi, "A MIDI controller.");
  visitor.section("page", desk.page, "The page in a browser.");
  visitor.section("process", desk.process, "The process of the service.");
}

}  // namespace handcast::config
