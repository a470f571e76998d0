// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings/field.hpp"
#include "ipc/base/result.hpp"

namespace handcast::desk {

/// The type of a setting.
enum class Kind { toggle, whole, number, text, choice, numbers, texts };

/// What a live setting is; constant while the rig is up.
struct Control {
  std::string path;                ///< e.g. "projector.brightness", its section, a dot, its name
  Kind kind = Kind::number;        ///< its type
  config::Range range;             ///< whole, number, numbers: the allowed values and their unit
  std::vector<std::string> words;  ///< choice: the allowed ones
  std::string sentence;            ///< what it does
  /// Its values without and with the rig file, as TOML: "0.5", "true", "\"vertices\"", "[0, 1]".
  /// @{
  std::string initial, filed;
  /// @}
};

/// The values of all controls at one time.
struct Values {
  std::uint64_t revision = 0;     ///< increases with every change
  std::vector<std::string> toml;  ///< by control, as TOML
  std::string source;             ///< who made the last change: "osc 10.0.0.7", "cue 3"
  std::string change;             ///< what it was: "projector.brightness = 0.5"
  bool can_undo = false, can_redo = false;
};

/// The live settings of the rig, for everything that a person turns: the page, OSC, MIDI, cues,
/// gestures. All functions may be called by any thread; none blocks for longer than 2 s.
class Panel {
 public:
  virtual ~Panel() = default;

  /// All live settings, in the order of config/REFERENCE.md.
  virtual std::span<const Control> controls() const = 0;
  /// Their values now.
  virtual std::shared_ptr<const Values> values() const = 0;

  /// Changes settings, all or none: "projector.brightness=0.5", values as in --set; without a value
  /// behind the path ("projector.brightness"), that of the rig file. `source`: for the log. Errors:
  /// bad_config (one sentence a fault), unavailable (the rig does not take it).
  virtual Result<void> set(std::span<const std::string> assignments, std::string_view source) = 0;
  /// Takes back the last change, and does it again. Changes of one control by one source within a
  /// second are one. Errors: bad_config (there is none).
  /// @{
  virtual Result<void> undo(std::string_view source) = 0;
  virtual Result<void> redo(std::string_view source) = 0;
  /// @}

  /// Named sets of values. load() replaces all live values by those of a preset; store() makes or
  /// replaces a preset of the present values; save() keeps the present values for the next start of
  /// the rig (RIG.live.toml). Errors: bad_config (no such preset; not a name), unavailable (files).
  /// @{
  virtual std::vector<std::string> presets() const = 0;
  virtual Result<void> load(std::string_view preset, std::string_view source) = 0;
  virtual Result<void> store(std::string_view preset) = 0;
  virtual Result<void> save() = 0;
  /// @}

  /// Shows content on hands ("left", "right", "both"), as `handcast content` does. Returns without
  /// waiting for its first picture. Errors: bad_config, unavailable.
  virtual Result<void> show(std::string_view hand, std::string_view content,
                            std::string_view source) = 0;
};

/// The index of the control at `path`; empty if there is none.
inline std::optional<std::size_t> find_control(std::span<const Control> controls,
                                               std::string_view path) {
  for (std::size_t i = 0; i < controls.size(); ++i)
    if (controls[i].path == path) return i;
  return std::nullopt;
}

}  // namespace handcast::desk
