// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "config/rig.hpp"
#include "config/settings/document.hpp"
#include "config/settings/files.hpp"
#include "config/settings/load.hpp"
#include "config/settings/quoted.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::sweep {

/// A section that Reader reads. It is declared so that the loader suggests it for a mistyped name.
struct ReadByHand {};
template <class Visitor>
void describe(Visitor&, ReadByHand&) {}

/// The settings at the top level of a plan file.
struct Head {
  std::string rig = "../rigs/twin.toml";
  std::string settings_from;
  double seconds = Plan().seconds;
  double warm_up_s = Plan().warm_up_s;
  int draw_every = Plan().draw_every;
  double draw_hz = Plan().draw_hz;
  bool joints_only = false;
  ReadByHand settings, variant, grid;
};

template <class Visitor>
void describe(Visitor& visitor, Head& head) {
  visitor.field("rig", head.rig, "Rig file of the variants without one, relative to the plan.");
  visitor.field("settings_from", head.settings_from,
                "TOML file with settings of all runs, which several plans share; relative to the "
                "plan. Those of the plan itself take precedence.");
  visitor.field("seconds", head.seconds, config::between(0.01, 86400, "s"),
                "Scored time of each run.");
  visitor.field("warm_up_s", head.warm_up_s, config::between(0, 3600, "s"),
                "Time before it that is not scored.");
  visitor.field("draw_every", head.draw_every, config::between(1, 100000),
                "Draws and scores every N-th projector frame.");
  visitor.field("draw_hz", head.draw_hz, config::between(0, 10000, "Hz"),
                "In place of draw_every: about so many projector frames a second are drawn and "
                "scored, whatever the projector's rate. 0: draw_every counts.");
  visitor.field("joints_only", head.joints_only, "Draws nothing and scores only the landmarks.");
  visitor.section("settings", head.settings, "Settings of all runs.");
  visitor.section("variant", head.variant, "Variants of the rig.");
  visitor.section("grid", head.grid,
                  "Lists of values of which all combinations are run. Several as [[grid]].");
}

/// The settings at the top level of a [[variant]].
struct VariantHead {
  std::string name, rig, poses, landmarks;
  std::vector<std::string> from;
  ReadByHand settings;
};

template <class Visitor>
void describe(Visitor& visitor, VariantHead& head) {
  visitor.field("name", head.name, "Name of the variant.");
  visitor.field("rig", head.rig, "Rig file of the variant, relative to the plan.");
  visitor.field(
      "from", head.from,
      "Variants above whose settings it has, too; of a setting that several have, the last "
      "counts, and its own counts most. Its rig is that of the first, if it has none.");
  visitor.field("poses", head.poses,
                "Folder with the results of a tracker, 000.csv or .npy and so on: a file for each "
                "case, in the order of the grids.");
  visitor.field("landmarks", head.landmarks, "The same of a detector.");
  visitor.section("settings", head.settings, "Settings of the variant's runs.");
}

namespace {

using config::Value;

constexpr int kMostParts = 32;  ///< of a path; the reader of TOML allows no more either

/// The value as in "path=value": text without quotes, except in a list.
std::string print(const Value& value) {
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value.data)) return fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&value.data)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value.data)) return *text;
  std::vector<std::string> texts;
  if (const auto* array = std::get_if<config::Array>(&value.data))
    for (const auto& element : *array) {
      const auto* text = std::get_if<std::string>(&element.data);
      texts.push_back(text ? config::quoted(*text) : print(element));
    }
  return fmt::format("[{}]", join(texts, ", "));
}

/// A document that sets one path, which the loader of rigs can check.
Value nested(std::string_view path, Value value) {
  const auto dot = path.rfind('.');
  Value table{config::Table{{std::string(path.substr(dot == path.npos ? 0 : dot + 1)), value}},
              value.line};
  return dot == path.npos ? table : nested(path.substr(0, dot), std::move(table));
}

/// The values of a section by their full paths: "a.b" = 1, a.b = 1 and [a] b = 1 are the same.
void flatten(const config::Table& table, const std::string& outer, config::Table& flat) {
  for (const auto& [name, value] : table) {
    const auto path = outer.empty() ? name : fmt::format("{}.{}", outer, name);
    if (const auto* members = std::get_if<config::Table>(&value.data)) {
      flatten(*members, path, flat);
    } else {
      flat.push_back({path, value});
    }
  }
}

/// Reads one plan file and collects its faults.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file)
      : plan_file_(file),
        file_(file),
        folder_(std::filesystem::absolute(file).parent_path()),
        listing_(config::list_settings(scratch_)) {}

  Result<Plan> read(const Value& document) {
    Head head;
    names_rig_ = section(std::get<config::Table>(document.data), "rig") != nullptr;
    const auto [rest, sections] = split(document, {"settings", "variant", "grid"});
    config::apply_document(rest, file_.string(), config::list_settings(head), faults_);

    auto shared = shared_settings(head.settings_from);
    Plan plan{file_.stem().string(),
              file_,
              head.seconds,
              head.warm_up_s,
              head.joints_only ? 0 : head.draw_every,
              head.joints_only ? 0 : head.draw_hz,
              fixed(section(sections, "settings")),
              {},
              grids(section(sections, "grid"))};
    variants(section(sections, "variant"), head, plan);
    check_fixed_once(plan);
    plan.settings.insert(plan.settings.begin(), std::make_move_iterator(shared.begin()),
                         std::make_move_iterator(shared.end()));
    if (!faults_.empty()) return tl::make_unexpected(faults_.to_error());
    return plan;
  }

 private:
  void complain(int line, std::string_view path, std::string_view sentence) {
    faults_.add(fmt::format("{}:{}: {}: {}", file_.string(), line, path, sentence));
  }

  /// The members of a document with these names, and the others.
  struct Split {
    Value rest;
    config::Table sections;
  };
  static Split split(const Value& document, const std::vector<std::string_view>& names) {
    config::Table rest, sections;
    for (const auto& member : std::get<config::Table>(document.data))
      (std::ranges::find(names, member.name) == names.end() ? rest : sections).push_back(member);
    return {{std::move(rest), document.line}, std::move(sections)};
  }

  static const Value* section(const config::Table& sections, std::string_view name) {
    const auto found = std::ranges::find(sections, name, &config::Member::name);
    return found == sections.end() ? nullptr : &found->value;
  }

  config::Table members(const Value* section, std::string_view name) {
    config::Table flat;
    if (!section) return flat;
    if (const auto* table = std::get_if<config::Table>(&section->data)) {
      flatten(*table, "", flat);
      std::erase_if(flat, [&](const config::Member& member) { return is_too_deep(member); });
    } else {
      complain(section->line, name,
               fmt::format("must be a section, not {}", config::kind_of(*section)));
    }
    return flat;
  }

  bool is_too_deep(const config::Member& member) {
    if (std::ranges::count(member.name, '.') < kMostParts) return false;
    complain(member.value.line, member.name.substr(0, 60) + "...", "there is no such setting");
    return true;
  }

  Choice choice(const std::string& path, const Value& value) {
    const auto document = nested(path, value);
    config::apply_document(document, file_.string(), listing_, faults_);
    const auto text = print(value);
    // A path in the home folder is absolute as it is: the rig's reader expands it.
    const bool is_path = config::is_path(path, text) && !text.starts_with('~');
    return {text, is_path ? (folder_ / text).lexically_normal().string() : text, value.line};
  }

  std::vector<Axis> fixed(const Value* settings) {
    std::vector<Axis> axes;
    for (const auto& [path, value] : members(settings, "settings"))
      axes.push_back({path, {choice(path, value)}});
    return axes;
  }

  /// The settings of the file that several plans share. Those of the plan and its grid take
  /// precedence.
  std::vector<Axis> shared_settings(const std::string& shared) {
    if (shared.empty()) return {};
    const auto file = (folder_ / shared).lexically_normal();
    const auto text = config::read_text(file);
    const auto document = text ? config::parse_document(*text, file.string())
                               : Result<Value>(tl::make_unexpected(text.error()));
    if (!document) {
      faults_.add(document.error().what);
      return {};
    }
    file_ = file;  // whose lines are named if a setting is wrong
    auto settings = fixed(&*document);
    file_ = plan_file_;
    return settings;
  }

  std::vector<Grid> grids(const Value* listed) {
    const auto* array = listed ? std::get_if<config::Array>(&listed->data) : nullptr;
    if (!array) return {grid(listed)};
    if (array->empty()) complain(listed->line, "grid", "is an empty list: there is nothing to run");
    std::vector<Grid> read;
    for (const auto& element : *array) read.push_back(grid(&element));
    return read;
  }

  Grid grid(const Value* section) {
    Grid axes;
    for (const auto& [path, value] : members(section, "grid")) {
      const auto* values = std::get_if<config::Array>(&value.data);
      if (!values || values->empty()) {
        complain(value.line, path, "must be a list of values");
        continue;
      }
      if (std::ranges::find(axes, path, &Axis::path) != axes.end())
        complain(value.line, path, "occurs twice in the grid");
      axes.push_back({path, {}});
      for (const auto& each : *values) axes.back().choices.push_back(choice(path, each));
    }
    return axes;
  }

  void variants(const Value* listed, const Head& head, Plan& plan) {
    const auto* array = listed ? std::get_if<config::Array>(&listed->data) : nullptr;
    if (listed && !array)
      complain(listed->line, "variant", "must be a list of sections: write [[variant]]");
    if (!array) {
      const auto file = (folder_ / head.rig).lexically_normal();
      plan.variants.push_back({file.stem().string(), file, rig_text(file, 1), {}});
      return;
    }
    if (array->empty())
      complain(listed->line, "variant", "is an empty list: there is nothing to run");
    for (const auto& element : *array) {
      if (!std::holds_alternative<config::Table>(element.data)) {
        complain(element.line, "variant", "must be a section: write [[variant]]");
        continue;
      }
      auto read = variant(element, head.rig, plan.variants);
      if (std::ranges::find(plan.variants, read.name, &Variant::name) != plan.variants.end())
        complain(element.line, "variant.name", "two variants are called " + quote(read.name));
      plan.variants.push_back(std::move(read));
    }
  }

  /// The last value of a setting counts.
  static void set(std::vector<Axis>& settings, Axis setting) {
    std::erase_if(settings, [&](const Axis& other) { return other.path == setting.path; });
    settings.push_back(std::move(setting));
  }

  Variant variant(const Value& element, const std::string& default_rig,
                  std::span<const Variant> above) {
    VariantHead head;
    const auto [rest, sections] = split(element, {"settings"});
    config::apply_document(rest, file_.string(), config::list_settings(head), faults_);
    if (head.name.empty()) complain(element.line, "variant.name", "is missing");
    Variant read{head.name, folder_ / (head.rig.empty() ? default_rig : head.rig), {}, {}};
    for (const auto& name : head.from) {
      const auto base = std::ranges::find(above, name, &Variant::name);
      if (base == above.end()) {
        complain(element.line, "variant.from", "no variant above is called " + quote(name));
        continue;
      }
      if (head.rig.empty() && name == head.from.front()) read.rig_file = base->rig_file;
      for (const auto& setting : base->settings) set(read.settings, setting);
    }
    for (auto& setting : fixed(section(sections, "settings")))
      set(read.settings, std::move(setting));
    read.rig_file = read.rig_file.lexically_normal();
    if (!head.poses.empty()) read.poses = (folder_ / head.poses).lexically_normal();
    if (!head.landmarks.empty()) read.landmarks = (folder_ / head.landmarks).lexically_normal();
    read.rig_text = rig_text(read.rig_file, element.line);
    return read;
  }

  /// Reads a rig file. Its faults are reported once, even if several variants name it.
  std::string rig_text(const std::filesystem::path& rig, int line) {
    auto text = config::read_text(rig);
    const bool new_here = std::ranges::find(judged_, rig) == judged_.end();
    judged_.push_back(rig);
    if (!text) {
      const bool is_unwritten = !names_rig_ && rig == (folder_ / Head().rig).lexically_normal();
      const auto why = is_unwritten
                           ? fmt::format(
                                 "is missing, and there is no {}, which is read in its place; "
                                 "write the path of a rig file, relative to the plan",
                                 Head().rig)
                           : text.error().what;
      if (new_here) complain(is_unwritten ? 1 : line, "rig", why);
      return {};
    }
    if (const auto parsed = config::parse_rig(*text, rig); !parsed && new_here)
      faults_.add(parsed.error().what);
    return *text;
  }

  void check_fixed_once(const Plan& plan) {
    const auto check = [&](const std::vector<Axis>& settings) {
      for (const auto& setting : settings)
        for (const auto& grid : plan.grids)
          if (const auto axis = std::ranges::find(grid, setting.path, &Axis::path);
              axis != grid.end())
            complain(setting.choices.front().line, setting.path,
                     fmt::format("is fixed here, but is also an axis of a grid (line {})",
                                 axis->choices.front().line));
    };
    check(plan.settings);
    for (const auto& variant : plan.variants) check(variant.settings);
  }

  std::filesystem::path plan_file_;
  std::filesystem::path file_;    ///< the file that is read
  std::filesystem::path folder_;  ///< of the plan
  bool names_rig_ = false;        ///< at its top level
  config::Rig scratch_;           ///< receives each value when it is checked
  config::Listing listing_;
  config::Faults faults_;
  std::vector<std::filesystem::path> judged_;
};

}  // namespace

std::vector<std::string> Plan::axes() const {
  std::vector<std::string> paths;
  for (const auto& grid : grids)
    for (const auto& axis : grid)
      if (std::ranges::find(paths, axis.path) == paths.end()) paths.push_back(axis.path);
  return paths;
}

Result<Plan> parse_plan(const std::string& toml, const std::filesystem::path& file) {
  const auto document = config::parse_document(toml, file.string());
  if (!document) return tl::make_unexpected(document.error());
  return Reader(file).read(*document);
}

Result<Plan> load_plan(const std::filesystem::path& file) {
  const auto text = config::read_text(file);
  if (!text) return tl::make_unexpected(text.error());
  return parse_plan(*text, file);
}

}  // namespace handcast::sweep
