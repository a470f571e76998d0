// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "config/content_chain.hpp"
#include "config/live/live_board.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/content_state.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"

namespace handcast::supervisor {
namespace {

using namespace std::chrono_literals;
using States = client::Stream<msg::ContentState>;

constexpr std::array<std::string_view, msg::kMaxHands> kHands{"left", "right"};

/// The service compiles shaders and opens files before it answers.
constexpr auto kPatience = 10s;

struct Wish {
  std::string content, transition, hand = "both", rig;
  double transition_s = -1;
};

/// What handcast brings along, by what it is.
void print_looks() {
  constexpr std::array kKinds{std::pair("Generator", "looks"), std::pair("Filter", "filters"),
                              std::pair("Transition", "transitions")};
  std::array<std::vector<std::string>, kKinds.size()> names;
  std::error_code absent;
  for (const auto& file : std::filesystem::directory_iterator(assets_folder() / "looks", absent)) {
    if (file.path().extension() != ".fs") continue;
    const auto text = read_input(file.path(), 1 << 20).value_or("");
    for (std::size_t i = 0; i < kKinds.size(); ++i)
      if (text.find(fmt::format("\"CATEGORIES\": [\"{}\"", kKinds[i].first)) != text.npos)
        names[i].push_back(file.path().stem().string());
  }
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    std::ranges::sort(names[i]);
    fmt::print("{}: {}\n", kKinds[i].second, join(names[i], ", "));
  }
}

/// The changes of settings that show what is wished for.
std::vector<std::string> changes_of(const Wish& wish) {
  std::vector<std::string> changes;
  for (const auto hand : kHands)
    if (wish.hand == "both" || wish.hand == hand)
      changes.push_back(fmt::format("content.{}={}", hand, wish.content));
  return changes;
}

/// The changes that show again what was there.
std::vector<std::string> changes_back(const Wish& wish, const config::Content& before) {
  std::vector<std::string> changes;
  for (const auto hand : kHands)
    if (wish.hand == "both" || wish.hand == hand)
      changes.push_back(
          fmt::format("content.{}={}", hand, hand == "left" ? before.left : before.right));
  return changes;
}

/// Errors: bad_config (it makes no sense), unavailable. Returns the number of the change.
Result<std::uint64_t> send(const Wish& wish, config::LiveBoard& board) {
  config::Transition transition{wish.transition, wish.transition_s};
  if (!wish.transition.empty()) {
    std::error_code gone;
    auto resolved = config::resolve_content(wish.transition, std::filesystem::current_path(gone));
    if (!resolved) return fail_in("--transition", resolved.error());
    transition.name = std::move(*resolved);
  }
  return board.set(changes_of(wish), "command line", transition);
}

void print(const msg::ContentState& state, bool as_json) {
  auto json = nlohmann::json::object();
  for (std::size_t i = 0; i < kHands.size(); ++i) {
    const auto& hand = state.hands[i];
    const std::string content(hand.content.view()), fault(hand.fault.view());
    json[kHands[i]] = {{"content", content}, {"draw_ms", hand.draw_ms}, {"fault", fault}};
    if (as_json) continue;
    fmt::print("{:<6} {} ({:.1f} ms a picture)\n", kHands[i], printable(content), hand.draw_ms);
    if (!fault.empty()) fmt::print("       {}\n", printable(fault));
  }
  if (as_json)
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

/// What the service says about a change. Errors: bad_config (it was refused), timeout (no answer).
Result<void> wait_for(States& states, const Wish& wish, std::uint64_t change) {
  const auto until = Deadline::in(kPatience);
  for (;;) {
    const auto state = states.latest(until);
    if (!state && state.error().code == Errc::timeout)
      return fail(Errc::timeout, fmt::format("the content service has not answered within {} s; "
                                             "`handcast status` says how it is",
                                             kPatience / 1s));
    if (!state) return tl::make_unexpected(state.error());
    std::string faults;
    bool is_done = true;
    for (std::size_t i = 0; i < kHands.size(); ++i) {
      const auto& hand = (*state)->hands[i];
      if (wish.hand != "both" && wish.hand != kHands[i]) continue;
      is_done &= hand.command >= change;
      if (faults.find(hand.fault.view()) == faults.npos || faults.empty())
        faults += hand.fault.view();
    }
    if (!is_done) continue;
    return faults.empty() ? Result<void>() : fail(Errc::bad_config, faults);
  }
}

int show(const std::string& rig, bool as_json) {
  auto states = client::open_stream<msg::ContentState>(rig, "content.state");
  if (!states) return complain(states.error());
  const auto state = states->latest(Deadline::in(2s));
  if (!state) return complain(state.error());
  print(**state, as_json);
  if (!as_json) print_looks();
  return kExitDone;
}

int change(const Wish& wish) {
  auto states = client::open_stream<msg::ContentState>(wish.rig, "content.state");
  if (!states) return complain(states.error());
  auto board = config::LiveBoard::open(wish.rig);
  if (!board) return complain(board.error());
  const auto before = board->rig_now();
  if (!before) return complain(before.error());
  const auto change = send(wish, *board);
  if (!change) return complain(change.error());
  const auto answer = wait_for(*states, wish, *change);
  if (answer) return kExitDone;
  // What cannot be drawn must not be kept by `handcast save`.
  if (const auto now = board->now(); now && now->header.frame_id == *change)
    if (const auto back = board->set(changes_back(wish, before->content), "command line"); !back)
      return complain(back.error());
  return complain(answer.error());
}

/// `handcast content --try` is a program of its own, which needs no rig.
int try_sources(Arguments arguments) {
  const auto program = (program_folder() / "handcast-try").string();
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  std::erase(arguments, "--try");
  for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  execv(program.c_str(), pointers.data());
  return complain(kExitConfig,
                  fmt::format("the program {} is missing; `scripts/build` builds all", program));
}

}  // namespace

int run_content(const Arguments& arguments) {
  if (std::ranges::find(arguments, "--try") != arguments.end()) return try_sources(arguments);
  auto line = command_line_of(
      "content",
      "WHAT is written as content.left in a rig file: a look, a picture, a film, a shader, or "
      "several joined by \" | \".\nWithout WHAT: prints what is on the hands, and the looks, "
      "filters and transitions.\n"
      "handcast content --try SOURCE... draws sources without a rig; --try --help explains it.");
  Wish wish;
  std::vector<std::string> words;
  bool as_json = false;
  line.add("[WHAT...]", words, "What to show from now on");
  line.add("--hand left|right|both", wish.hand, "On which hand");
  line.add("--transition NAME", wish.transition,
           "How to get there: cut, fade or an ISF transition; as in the rig file if left out");
  line.add("--seconds S", wish.transition_s, "How long that takes; as in the rig file if left out",
           {0, 60});
  line.add("--json", as_json, "What is on the hands as JSON");
  add_rig(line, wish.rig);
  if (const auto code = line.answered(arguments)) return *code;
  for (const auto& word : words) wish.content += (wish.content.empty() ? "" : " ") + word;
  const auto rig = choose_rig(wish.rig);
  if (!rig) return complain(rig.error());
  wish.rig = *rig;
  return wish.content.empty() ? show(wish.rig, as_json) : change(wish);
}

}  // namespace handcast::supervisor
