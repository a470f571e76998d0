// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "config/settings/choice.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// A reference to an enum whose type is erased: the target of a setting that is one of several
/// words.
struct ChoiceTarget {
  void* value;                                     ///< the enum
  std::size_t (*index)(const void* value);         ///< the number of its enumerator
  void (*assign)(void* value, std::size_t index);  ///< sets it by number
  std::vector<std::string_view> words;             ///< the words in the order of the enumerators

  /// Refers to `value`, which must outlive the result.
  template <Choice Enum>
  static ChoiceTarget of(Enum& value) {
    const auto words = words_of(value);
    return {&value,
            [](const void* at) { return static_cast<std::size_t>(*static_cast<const Enum*>(at)); },
            [](void* at, std::size_t index) { *static_cast<Enum*>(at) = static_cast<Enum>(index); },
            {words.begin(), words.end()}};
  }
  /// The word of the present value.
  std::string_view word() const { return words[index(value)]; }
};

/// The value of a setting, in the struct that holds it.
using Target = std::variant<bool*, int*, double*, std::string*, std::vector<double>*,
                            std::vector<std::string>*, ChoiceTarget>;

/// One declared setting of a struct, which must outlive it.
struct Setting {
  std::string path;                 ///< e.g. "camera.replay.loop"
  Target target;                    ///< the value
  Range range;                      ///< the allowed numbers and their unit
  std::string_view sentence;        ///< the description
  Effect effect = Effect::restart;  ///< when a change takes effect

  /// The last part of the path: "loop".
  std::string_view name() const { return std::string_view(path).substr(path.rfind('.') + 1); }
  /// The allowed words if the setting is a choice; empty otherwise.
  std::span<const std::string_view> words() const {
    const auto* choice = std::get_if<ChoiceTarget>(&target);
    return choice ? std::span<const std::string_view>(choice->words)
                  : std::span<const std::string_view>();
  }
};

/// One declared section.
struct Section {
  std::string path;               ///< e.g. "camera.replay"; empty for the top level of the file
  std::string_view sentence;      ///< the description
  std::vector<Setting> settings;  ///< its settings without those of inner sections
};

/// All sections of a struct in the order of declaration, each before its inner sections. Refers to
/// the struct, which must outlive it.
using Listing = std::vector<Section>;

/// The visitor of describe() that makes a Listing, on which loader, printer and reference are
/// based.
class Collector {
 public:
  /// Adds the top level of the file to `listing`, which must outlive this object.
  explicit Collector(Listing& listing) : listing_(listing) { listing_.push_back({}); }

  /// Declares a setting of the section that is being described. `value`, `sentence` and the unit in
  /// `range` must outlive the listing.
  /// @{
  void field(std::string_view name, bool& value, std::string_view sentence,
             std::optional<Effect> effect = {}) {
    add(name, &value, {}, sentence, effect);
  }
  void field(std::string_view name, std::string& value, std::string_view sentence,
             std::optional<Effect> effect = {}) {
    add(name, &value, {}, sentence, effect);
  }
  void field(std::string_view name, std::vector<std::string>& value, std::string_view sentence,
             std::optional<Effect> effect = {}) {
    add(name, &value, {}, sentence, effect);
  }
  template <Choice Enum>
  void field(std::string_view name, Enum& value, std::string_view sentence,
             std::optional<Effect> effect = {}) {
    add(name, ChoiceTarget::of(value), {}, sentence, effect);
  }
  template <class T>
  requires std::same_as<T, int> || std::same_as<T, double> || std::same_as<T, std::vector<double>>
  void field(std::string_view name, T& value, Range range, std::string_view sentence,
             std::optional<Effect> effect = {}) {
    add(name, &value, range, sentence, effect);
  }
  /// @}

  /// Declares an inner section: calls describe() for `members`.
  template <class T>
  void section(std::string_view name, T& members, std::string_view sentence,
               std::optional<Effect> effect = {}) {
    const auto outer = index_;
    const auto outer_effect = effect_;
    index_ = listing_.size();
    if (effect) effect_ = *effect;
    listing_.push_back({path_of(outer, name), sentence, {}});
    describe(*this, members);
    index_ = outer;
    effect_ = outer_effect;
  }

 private:
  std::string path_of(std::size_t section, std::string_view name) const {
    const auto& outer = listing_[section].path;
    return outer.empty() ? std::string(name) : outer + "." + std::string(name);
  }
  void add(std::string_view name, Target target, Range range, std::string_view sentence,
           std::optional<Effect> effect) {
    listing_[index_].settings.push_back(
        {path_of(index_, name), std::move(target), range, sentence, effect.value_or(effect_)});
  }

  Listing& listing_;
  std::size_t index_ = 0;            ///< of the section that is being described
  Effect effect_ = Effect::restart;  ///< of the settings of that section that say none
};

/// The settings that describe() declares for `declared`, which must outlive the listing.
template <class T>
Listing list_settings(T& declared) {
  Listing listing;
  Collector collector(listing);
  describe(collector, declared);
  return listing;
}

/// The setting at `path`, inside `listing`; null if there is none.
const Setting* find_setting(const Listing& listing, std::string_view path);

/// The value in TOML: true, 525, "twin", [0.1, 2], ["a", "b"].
std::string print_value(const Setting& setting);

/// The allowed values: "1..2000 Hz", "at least 0 ms", "one of: hold, velocity"; empty if all are
/// allowed.
std::string print_allowed(const Setting& setting);

/// A commented TOML file with all settings; `title` is its first comment.
std::string print_settings(const Listing& listing, std::string_view title);

}  // namespace handcast::config
