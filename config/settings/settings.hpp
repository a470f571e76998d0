// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "config/settings/choice.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// A setting that is one of several words: an enum somewhere, without its type.
struct ChoiceTarget {
  void* value;
  std::size_t (*index)(const void* value);
  void (*assign)(void* value, std::size_t index);
  std::vector<std::string_view> words;

  template <Choice Enum>
  static ChoiceTarget of(Enum& value) {
    const auto words = words_of(value);
    return {&value,
            [](const void* at) { return static_cast<std::size_t>(*static_cast<const Enum*>(at)); },
            [](void* at, std::size_t index) { *static_cast<Enum*>(at) = static_cast<Enum>(index); },
            {words.begin(), words.end()}};
  }
  std::string_view word() const { return words[index(value)]; }
};

/// Where a setting's value lives.
using Target = std::variant<bool*, int*, double*, std::string*, std::vector<double>*, ChoiceTarget>;

/// One declared setting of a living struct.
struct Setting {
  std::string path;  ///< "camera.replay.loop"
  Target target;
  Range range;
  std::string_view sentence;

  std::string_view name() const { return std::string_view(path).substr(path.rfind('.') + 1); }
  /// What it may be, if it is a choice; empty otherwise.
  std::span<const std::string_view> words() const {
    const auto* choice = std::get_if<ChoiceTarget>(&target);
    return choice ? std::span<const std::string_view>(choice->words)
                  : std::span<const std::string_view>();
  }
};

struct Section {
  std::string path;  ///< "" is the file itself
  std::string_view sentence;
  std::vector<Setting> settings;  ///< its own, not those of the sections inside it
};

/// Every section of a struct in the order of declaration, an outer one before those inside it.
/// Borrows the struct.
using Listing = std::vector<Section>;

/// The visitor that turns declarations into a Listing; loader, printer and reference work on that.
class Collector {
 public:
  explicit Collector(Listing& listing) : listing_(listing) { listing_.push_back({}); }

  void field(std::string_view name, bool& value, std::string_view sentence) {
    add(name, &value, {}, sentence);
  }
  void field(std::string_view name, std::string& value, std::string_view sentence) {
    add(name, &value, {}, sentence);
  }
  template <Choice Enum>
  void field(std::string_view name, Enum& value, std::string_view sentence) {
    add(name, ChoiceTarget::of(value), {}, sentence);
  }
  template <class T>
  requires std::same_as<T, int> || std::same_as<T, double> || std::same_as<T, std::vector<double>>
  void field(std::string_view name, T& value, Range range, std::string_view sentence) {
    add(name, &value, range, sentence);
  }

  template <class T>
  void section(std::string_view name, T& members, std::string_view sentence) {
    const auto outer = index_;
    index_ = listing_.size();
    listing_.push_back({path_of(outer, name), sentence, {}});
    describe(*this, members);
    index_ = outer;
  }

 private:
  std::string path_of(std::size_t section, std::string_view name) const {
    const auto& outer = listing_[section].path;
    return outer.empty() ? std::string(name) : outer + "." + std::string(name);
  }
  void add(std::string_view name, Target target, Range range, std::string_view sentence) {
    listing_[index_].settings.push_back(
        {path_of(index_, name), std::move(target), range, sentence});
  }

  Listing& listing_;
  std::size_t index_ = 0;  ///< of the section that is being described
};

template <class T>
Listing list_settings(T& declared) {
  Listing listing;
  Collector collector(listing);
  describe(collector, declared);
  return listing;
}

/// The setting at `path`; nullptr where there is none.
const Setting* find_setting(const Listing& listing, std::string_view path);

/// The value as TOML writes it: true, 525, "twin", [0.1, 2].
std::string print_value(const Setting& setting);

/// "1..2000 Hz", "at least 0 ms", "one of: hold, velocity"; empty where everything goes.
std::string print_allowed(const Setting& setting);

/// A commented TOML file of every setting; `title` becomes its first comment.
std::string print_settings(const Listing& listing, std::string_view title);

}  // namespace handcast::config
