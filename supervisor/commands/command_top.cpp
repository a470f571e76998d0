// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <deque>
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/look/top/top_layout.hpp"
#include "supervisor/look/top/top_look.hpp"
#include "supervisor/look/top/top_terminal.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::int64_t kRefresh_ns = 500'000'000;
constexpr std::size_t kLooksBack = 4;  ///< rates are over the last two seconds
constexpr std::int64_t kOnce_ns = 1'000'000'000;
constexpr std::size_t kPlainColumns = 160;

int show_once(const std::string& rig, bool as_json) {
  RigWatcher watcher(rig);
  const auto before = watcher.observe();
  if (before.missing.empty()) sleep_until_ns(before.taken_ns + kOnce_ns);
  const auto now = watcher.observe();
  if (!now.figures) return complain(kExitRetry, now.missing);

  const auto model = compare(before, now);
  if (as_json) {
    fmt::print("{}\n",
               json_of(model).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return kExitDone;
  }
  for (const auto& line : lay_out(model, {.columns = kPlainColumns}))
    fmt::print("{}\n", print(line, false));
  return kExitDone;
}

/// The terminal and its scroll position.
class Screen {
 public:
  void show(const TopModel& model) {
    const auto [columns, rows] = terminal_.size();
    std::vector<std::string> texts;
    for (const auto& line : fit(lay_out(model, {columns, with_marks_}), columns, rows, first_))
      texts.push_back(print(line, true));
    terminal_.show(texts);
  }

  /// Shows `model` until `until_ns` and handles keys. Returns false if the user quits.
  bool watch(const TopModel& model, std::int64_t until_ns) {
    for (;;) {
      show(model);
      const auto keys = terminal_.wait(until_ns);
      if (!keys) return true;
      for (const auto key : *keys)
        if (!obey(key)) return false;
    }
  }

 private:
  bool obey(Key key) {
    const auto page = terminal_.size().rows / 2;
    switch (key) {
      case Key::quit:
        return false;
      case Key::up:
        first_ -= std::min<std::size_t>(first_, 1);
        break;
      case Key::down:
        ++first_;
        break;
      case Key::page_up:
        first_ -= std::min(first_, page);
        break;
      case Key::page_down:
        first_ += page;
        break;
      case Key::marks:
        with_marks_ = !with_marks_;
        break;
    }
    return true;
  }

  Terminal terminal_;
  bool with_marks_ = false;
  std::size_t first_ = 0;
};

int show_until_quit(const std::string& rig) {
  RigWatcher watcher(rig);
  Screen screen;
  std::deque<RigLook> looks{watcher.observe()};
  auto next_ns = now_ns();
  for (;;) {
    next_ns = std::max(next_ns + kRefresh_ns, now_ns());  // skips what was missed during a suspend
    if (!screen.watch(compare(looks.front(), looks.back()), next_ns)) return kExitDone;
    looks.push_back(watcher.observe());
    if (looks.size() > kLooksBack + 1) looks.pop_front();
  }
}

}  // namespace

int run_top(const Arguments& arguments) {
  auto line = command_line_of("top");
  bool once = false, as_json = false;
  std::string name;
  line.add("--once", once, "Prints one look and ends");
  line.add("--json", as_json, "Prints one look as JSON");
  add_rig(line, name);
  if (const auto code = line.answered(arguments)) return *code;
  const auto rig = choose_rig(name);
  if (!rig) return complain(rig.error());
  if (once || as_json || !Terminal::present()) return show_once(*rig, as_json);
  return show_until_quit(*rig);
}

}  // namespace handcast::supervisor
