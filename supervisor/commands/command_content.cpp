// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "config/content_chain.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/content_command.hpp"
#include "ipc/ring/writer.hpp"
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
  const auto folder = program_folder() / "../share/handcast/looks";
  for (const auto& file : std::filesystem::directory_iterator(folder, absent)) {
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

/// The command, with absolute paths. Errors: bad_config (it makes no sense, or is too long).
Result<msg::ContentCommand> command_of(const Wish& wish) {
  std::error_code gone;
  const auto here = std::filesystem::current_path(gone);
  const auto content = config::resolve_content(wish.content, here);
  if (!content) return tl::make_unexpected(content.error());
  msg::ContentCommand command;
  command.header.frame_id = static_cast<std::uint64_t>(now_ns());
  command.header.origin_ns = now_ns();
  command.hands = wish.hand == "both" ? 0b11 : wish.hand == "left" ? 0b01 : 0b10;
  command.transition_s = static_cast<float>(wish.transition_s);
  bool fits = command.content.set(*content);
  if (!wish.transition.empty()) {
    const auto transition = config::resolve_content(wish.transition, here);
    if (!transition) return fail_in("--transition", transition.error());
    fits &= command.transition.set(*transition);
  }
  if (!fits) return fail(Errc::bad_config, "the content has more than 4095 characters");
  return command;
}

Result<void> send(const std::string& rig, const msg::ContentCommand& command) {
  auto ring = client::rig_ring(rig, msg::kContentCommands);
  if (!ring) return tl::make_unexpected(ring.error());
  // Another command may be on its way.
  auto writer =
      ipc::Writer<msg::ContentCommand>::attach(std::move(ring->segment), Deadline::in(2s));
  if (!writer) return tl::make_unexpected(writer.error());
  writer->publish(command);
  return {};
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

/// What the service says about a command. Errors: bad_config (it was refused), timeout (no answer).
Result<void> wait_for(States& states, const msg::ContentCommand& command) {
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
    for (const auto side : {msg::Side::left, msg::Side::right}) {
      const auto& hand = (*state)->hands[static_cast<std::size_t>(side)];
      if (!command.is_for(side)) continue;
      is_done &= hand.command >= command.header.frame_id;
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
  const auto command = command_of(wish);
  if (!command) return complain(command.error());
  auto states = client::open_stream<msg::ContentState>(wish.rig, "content.state");
  if (!states) return complain(states.error());
  if (const auto sent = send(wish.rig, *command); !sent) return complain(sent.error());
  const auto answer = wait_for(*states, *command);
  return answer ? kExitDone : complain(answer.error());
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
