// SPDX-License-Identifier: Apache-2.0
#include "services/desk/midi/bindings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/settings/choice.hpp"
#include "config/settings/document.hpp"
#include "config/settings/load.hpp"
#include "config/settings/quoted.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "services/desk/controls/control_value.hpp"

namespace handcast::desk::midi {
namespace {

constexpr std::array<std::string_view, 5> kCommands{"cue.go", "cue.back", "cue.hold", "undo",
                                                    "redo"};
constexpr std::array<std::string_view, 3> kNamed{"cue.jump ", "cue.key ", "preset "};

/// Reads one [[binding]].
class BindingReader {
 public:
  BindingReader(std::string_view file, std::span<const Control> controls, config::Faults& faults)
      : file_(file), controls_(controls), faults_(faults) {}

  std::optional<Binding> read(const config::Value& value) {
    const auto* table = std::get_if<config::Table>(&value.data);
    if (!table) {
      complain(value, "a binding begins with [[binding]]");
      return std::nullopt;
    }
    Binding binding;
    is_good_ = true;
    for (const auto& [name, member] : *table) read_member(name, member, binding);
    if (!is_good_) return std::nullopt;
    if (auto fault = fault_of(binding, controls_); !fault.empty()) {
      complain(value, fault);
      return std::nullopt;
    }
    return binding;
  }

  void complain(const config::Value& value, std::string_view sentence) {
    is_good_ = false;
    faults_.add(fmt::format("{}:{}: {}", file_, std::max(value.line, 1), sentence));
  }

 private:
  void read_member(const std::string& name, const config::Value& value, Binding& binding) {
    if (name == "path") {
      const auto* text = std::get_if<std::string>(&value.data);
      text ? void(binding.path = *text) : complain(value, "path must be a text");
    } else if (name == "source") {
      const auto* text = std::get_if<std::string>(&value.data);
      const auto source = config::choice_named<Source>(text ? *text : "");
      source ? void(binding.source = *source)
             : complain(value, "source must be one of: controller, controller14, bend, note");
    } else if (name == "channel") {
      read_whole(name, value, 1, 16, binding.channel);
    } else if (name == "number") {
      read_whole(name, value, 0, 127, binding.number);
    } else if (name == "min" || name == "max") {
      read_end(name, value, name == "min" ? binding.min : binding.max);
    } else {
      complain(value,
               fmt::format("there is no '{}'{}", name,
                           suggest(name, {"path", "source", "channel", "number", "min", "max"})));
    }
  }
  void read_whole(const std::string& name, const config::Value& value, int least, int most,
                  int& into) {
    const auto* whole = std::get_if<std::int64_t>(&value.data);
    if (!whole || *whole < least || *whole > most)
      return complain(value, fmt::format("{} must be a whole number, {}..{}", name, least, most));
    into = static_cast<int>(*whole);
  }
  void read_end(const std::string& name, const config::Value& value, std::optional<double>& into) {
    const auto* whole = std::get_if<std::int64_t>(&value.data);
    const auto* number = std::get_if<double>(&value.data);
    if (!whole && (!number || !std::isfinite(*number)))
      return complain(value, fmt::format("{} must be a number", name));
    into = whole ? static_cast<double>(*whole) : *number;
  }

  std::string_view file_;
  std::span<const Control> controls_;
  config::Faults& faults_;
  bool is_good_ = true;
};

/// What is wrong with a binding of a number: its ends.
std::string fault_of_ends(const Binding& binding, const Control& control) {
  const double least = binding.min.value_or(control.range.min);
  const double most = binding.max.value_or(control.range.max);
  if (!std::isfinite(least) || !std::isfinite(most))
    return fmt::format("{} has no largest value; min and max must say what the ends of a knob are",
                       binding.path);
  for (const double end : {least, most})
    if (end < control.range.min || end > control.range.max)
      return fmt::format("{}: {} is outside {}", binding.path, end, print_allowed(control));
  return "";
}

}  // namespace

bool is_command(std::string_view path) {
  return std::ranges::find(kCommands, path) != kCommands.end() ||
         std::ranges::any_of(kNamed, [&](std::string_view name) {
           return path.starts_with(name) && path.size() > name.size();
         });
}

std::string print_source(const Binding& binding) {
  switch (binding.source) {
    case Source::bend:
      return fmt::format("bend of channel {}", binding.channel);
    case Source::note:
      return fmt::format("note {} of channel {}", binding.number, binding.channel);
    case Source::controller14:
      return fmt::format("controllers {} and {} of channel {}", binding.number, binding.number + 32,
                         binding.channel);
    case Source::controller:
      break;
  }
  return fmt::format("controller {} of channel {}", binding.number, binding.channel);
}

std::string fault_of(const Binding& binding, std::span<const Control> controls) {
  if (binding.source == Source::controller14 && binding.number > 31)
    return "number must be 0..31 for a controller14";
  if (is_command(binding.path)) return "";
  const auto at = find_control(controls, binding.path);
  if (!at) {
    std::vector<std::string_view> known(kCommands.begin(), kCommands.end());
    for (const auto& control : controls) known.push_back(control.path);
    return fmt::format("there is no live setting or command {}{}", quote(binding.path),
                       suggest(binding.path, known));
  }
  const auto& control = controls[*at];
  switch (control.kind) {
    case Kind::toggle:
    case Kind::choice:
      return "";
    case Kind::whole:
    case Kind::number:
      if (binding.source == Source::note)
        return fmt::format("{} is a number, which a key cannot turn; move a knob or a fader",
                           binding.path);
      return fault_of_ends(binding, control);
    default:
      return fmt::format("{} is a text or a list, which no knob can turn", binding.path);
  }
}

Result<std::vector<Binding>> parse_bindings(const std::string& toml, std::string_view file,
                                            std::span<const Control> controls) {
  const auto document = config::parse_document(toml, file);
  if (!document) return tl::make_unexpected(document.error());
  config::Faults faults;
  BindingReader reader(file, controls, faults);
  std::vector<Binding> bindings;
  for (const auto& [name, value] : std::get<config::Table>(document->data)) {
    const auto* array = std::get_if<config::Array>(&value.data);
    if (name != "binding" || !array) {
      reader.complain(value, "it has only bindings, which begin with [[binding]]");
      continue;
    }
    for (const auto& element : *array)
      if (auto binding = reader.read(element)) bindings.push_back(std::move(*binding));
  }
  if (!faults.empty()) return tl::make_unexpected(faults.to_error());
  return bindings;
}

std::string print_bindings(std::span<const Binding> bindings) {
  std::string text = "# What a MIDI controller turns: written by the desk, read at its start.\n";
  for (const auto& binding : bindings) {
    text += fmt::format("\n[[binding]]\npath = {}\nsource = \"{}\"\nchannel = {}\nnumber = {}\n",
                        config::quoted(binding.path), config::word_of(binding.source),
                        binding.channel, binding.number);
    if (binding.min) text += fmt::format("min = {}\n", *binding.min);
    if (binding.max) text += fmt::format("max = {}\n", *binding.max);
  }
  return text;
}

}  // namespace handcast::desk::midi
