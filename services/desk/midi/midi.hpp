// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/desk/base/cue_deck.hpp"
#include "services/desk/base/midi_learner.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"
#include "services/desk/midi/port/port.hpp"

namespace handcast::desk {

/// A MIDI controller as a surface. It works in a thread of its own, also without turn().
class MidiSurface : public Surface, public MidiLearner {};

/// Opens a device by a part of its name.
using OpenMidiPort = std::function<Result<std::unique_ptr<midi::Port>>(std::string_view device)>;

/// The MIDI controller of desk.midi.device. A device that is not there is looked for every second.
/// `bindings_file`: what turns what (RIG.midi.toml); learning writes it. `cues`: null if there is
/// no cue list. Both and the panel outlive the result. Null: desk.midi.device is empty. Errors:
/// bad_config (all faults of the bindings, each with its line).
Result<std::unique_ptr<MidiSurface>> open_midi(const config::Rig& rig,
                                               const std::filesystem::path& bindings_file,
                                               Panel& panel, CueDeck* cues,
                                               OpenMidiPort open_port = midi::open_port);

}  // namespace handcast::desk
