// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/desk/base/panel.hpp"

namespace handcast::desk::midi {

/// What a person moves.
enum class Source {
  controller,    ///< 0..127
  controller14,  ///< 0..16383: a controller 0..31 and the one 32 above it, its lower 7 bits
  bend,          ///< the pitch wheel of a channel, 0..16383: faders of Mackie Control
  note,          ///< a key: 0 or 1
};
constexpr std::array<std::string_view, 4> words_of(Source) {
  return {"controller", "controller14", "bend", "note"};
}
/// The largest number of a source.
constexpr int largest_of(Source source) {
  return source == Source::controller || source == Source::note ? 127 : 16383;
}

/// What turns what.
struct Binding {
  std::string path;  ///< of a setting or command, as MidiLearner::learn()
  Source source = Source::controller;
  int channel = 1;                 ///< 1..16
  int number = 0;                  ///< of the controller or key, 0..127; of a bend: 0
  std::optional<double> min, max;  ///< the values at both ends; empty: those of the setting

  bool operator==(const Binding&) const = default;
};

/// "controller 7 of channel 1".
std::string print_source(const Binding& binding);

/// A sentence if nothing of this kind can turn the path; "" if it can.
std::string fault_of(const Binding& binding, std::span<const Control> controls);
/// True for "cue.go", "preset NAME" and so on.
bool is_command(std::string_view path);

/// Reads what print_bindings() writes: [[binding]] with path, source, channel, number and perhaps
/// min and max. Errors: bad_config (all faults, each with file and line).
Result<std::vector<Binding>> parse_bindings(const std::string& toml, std::string_view file,
                                            std::span<const Control> controls);
std::string print_bindings(std::span<const Binding> bindings);

}  // namespace handcast::desk::midi
