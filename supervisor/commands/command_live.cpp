// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "config/live/live_board.hpp"
#include "config/live/live_values.hpp"
#include "config/live_files.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "ipc/client/stream.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"

namespace handcast::supervisor {
namespace {

using namespace std::chrono_literals;
using config::LiveBoard;
using config::Setting;

constexpr std::string_view kSource = "command line";

Result<LiveBoard> board_of(const std::string& name) {
  const auto rig = choose_rig(name);
  return rig ? LiveBoard::open(*rig) : tl::make_unexpected(rig.error());
}

/// Does something with the board of a rig. Returns the exit code.
template <class Work>
int with_board(const std::string& rig, const Work& work) {
  auto board = board_of(rig);
  if (!board) return complain(board.error());
  const auto done = work(*board);
  return done ? kExitDone : complain(done.error());
}

/// One live setting, as the file has it and now.
struct Shown {
  const Setting* setting;
  std::string filed;
  bool is_changed() const { return config::print_value(*setting) != filed; }
};

void print_one(const Shown& shown) {
  const auto value = config::print_value(*shown.setting);
  fmt::print("{} {} = {}\n", shown.is_changed() ? '*' : ' ', shown.setting->path, printable(value));
}

void explain(const Shown& shown) {
  print_one(shown);
  const auto allowed = config::print_allowed(*shown.setting);
  fmt::print("  {}{}\n", shown.setting->sentence, allowed.empty() ? "" : " (" + allowed + ")");
  if (shown.is_changed()) fmt::print("  in the rig file: {}\n", printable(shown.filed));
}

nlohmann::json json_of(const Shown& shown) {
  return {{"path", shown.setting->path},
          {"value", config::print_value(*shown.setting)},
          {"filed", shown.filed},
          {"allowed", config::print_allowed(*shown.setting)},
          {"sentence", shown.setting->sentence}};
}

/// A path names itself and, as a section, all settings in it.
bool is_in(std::string_view setting, std::string_view path) {
  return path.empty() || setting == path ||
         (setting.starts_with(path) && setting.substr(path.size()).starts_with('.'));
}

struct Query {
  std::string path, rig;
  bool changed = false, as_json = false;
};

Result<void> get(const LiveBoard& board, const Query& query) {
  auto rig = board.rig_now();
  if (!rig) return tl::make_unexpected(rig.error());
  auto filed = board.filed();
  const auto listing = config::list_settings(*rig), before = config::list_settings(filed);
  std::vector<Shown> all;
  std::vector<std::string_view> live;
  for (const auto& section : listing)
    for (const auto& setting : section.settings) {
      if (setting.effect != config::Effect::live) continue;
      live.push_back(setting.path);
      if (!is_in(setting.path, query.path)) continue;
      all.push_back({&setting, config::print_value(*config::find_setting(before, setting.path))});
    }
  if (all.empty())
    return fail(Errc::bad_config, fmt::format("{} is not a live setting{}", quote(query.path),
                                              config::find_setting(listing, query.path)
                                                  ? ", but takes effect when its service is started"
                                                  : suggest(query.path, live)));
  if (query.changed) std::erase_if(all, [](const Shown& shown) { return !shown.is_changed(); });
  if (query.as_json) {
    auto json = nlohmann::json::array();
    for (const auto& shown : all) json.push_back(json_of(shown));
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (all.size() == 1 && all.front().setting->path == query.path) {
    explain(all.front());
  } else {
    std::ranges::for_each(all, print_one);
  }
  return {};
}

}  // namespace

int run_set(const Arguments& arguments) {
  auto line = command_line_of(
      "set",
      "PATH=VALUE: as in --set; PATH alone: the value of the rig file again. All or none are "
      "changed, within two frames.\n`handcast get` lists the settings that can be changed.");
  std::vector<std::string> words;
  std::string rig;
  line.add("PATH[=VALUE]...", words, "What to change");
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  return with_board(rig, [&](LiveBoard& board) { return board.set(words, kSource); });
}

int run_get(const Arguments& arguments) {
  auto line = command_line_of("get",
                              "PATH: a setting, which is explained, or a section. A star marks "
                              "what was changed since the rig file was read.");
  Query query;
  line.add("[PATH]", query.path, "What to show; everything if left out");
  line.add("--changed", query.changed, "Only what was changed");
  line.add("--json", query.as_json, "As JSON");
  add_rig(line, query.rig);
  if (const auto code = line.answered(arguments)) return *code;
  return with_board(query.rig, [&](const LiveBoard& board) { return get(board, query); });
}

int run_watch(const Arguments& arguments) {
  auto line = command_line_of("watch", "Ends with Ctrl-C, or with the rig.");
  std::string name;
  add_rig(line, name);
  if (const auto code = line.answered(arguments)) return *code;
  const auto rig = choose_rig(name);
  if (!rig) return complain(rig.error());
  auto changes = client::open_stream<msg::LiveSettings>(*rig, msg::kLiveSettings);
  if (!changes) return complain(changes.error());
  for (;;) {
    const auto last = changes->latest(Deadline::in(1s));
    if (!last && last.error().code == Errc::timeout) continue;
    if (!last) return complain(last.error());
    fmt::print("{:<16} {}\n", printable((*last)->source.view()), printable((*last)->change.view()));
    std::fflush(stdout);
  }
}

int run_undo(const Arguments& arguments) {
  auto line = command_line_of("undo", "Changes of one setting within a second are one.");
  std::string rig;
  bool again = false;
  line.add("--redo", again, "Does again what was taken back last");
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  return with_board(
      rig, [&](LiveBoard& board) { return again ? board.redo(kSource) : board.undo(kSource); });
}

int run_save(const Arguments& arguments) {
  auto line = command_line_of(
      "save", "Writes RIG.live.toml beside the rig file, which is never written itself.");
  std::string rig;
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  return with_board(rig, [](const LiveBoard& board) {
    auto saved = board.save();
    if (saved) fmt::print("saved to {}\n", config::live_file_of(board.file()).string());
    return saved;
  });
}

int run_preset(const Arguments& arguments) {
  auto line = command_line_of("preset",
                              "NAME: replaces all live settings by those of a preset. Without it: "
                              "lists the presets. `handcast undo` goes back.");
  std::string name, rig;
  bool store = false;
  line.add("[NAME]", name, "The preset");
  line.add("--store", store, "Makes the preset NAME of the present settings");
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  if (store && name.empty()) return complain(kExitUsage, "preset: --store needs a NAME");
  return with_board(rig, [&](LiveBoard& board) -> Result<void> {
    if (store) return board.store(name);
    if (!name.empty()) return board.load(name, kSource).map([](auto) {});
    for (const auto& each : config::preset_names(board.file())) fmt::print("{}\n", each);
    return {};
  });
}

namespace {

/// `handcast blackout [on|off]`: a setting of the section [light] that is on or off.
int run_switch(const Arguments& arguments, std::string_view name) {
  auto line = command_line_of(std::string(name), "Without a word: on.");
  std::string word = "on", rig;
  line.add("[on|off]", word, "What it should be");
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  if (word != "on" && word != "off")
    return complain(kExitConfig, fmt::format("write on or off, not {}", quote(word)));
  const std::vector<std::string> change{fmt::format("light.{}={}", name, word == "on")};
  return with_board(rig, [&](LiveBoard& board) { return board.set(change, kSource); });
}

}  // namespace

int run_blackout(const Arguments& arguments) { return run_switch(arguments, "blackout"); }
int run_freeze(const Arguments& arguments) { return run_switch(arguments, "freeze"); }

int run_master(const Arguments& arguments) {
  auto line = command_line_of("master", "SHARE: of projector.brightness, 0 to 1.");
  std::string share, rig;
  double seconds = 0;
  line.add("SHARE", share, "How much light there should be");
  line.add("--seconds S", seconds, "How long the light takes to it", {0, 600});
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  const std::vector<std::string> change{"light.master=" + share,
                                        fmt::format("light.master_s={}", seconds)};
  return with_board(rig, [&](LiveBoard& board) { return board.set(change, kSource); });
}

}  // namespace handcast::supervisor
