// SPDX-License-Identifier: Apache-2.0
// handcast lamp: turns the lamp of the projector on and off, and says how it is.
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "config/live/live_board.hpp"
#include "config/settings/choice.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "services/desk/lamp/pjlink.hpp"

namespace handcast::lamp {
namespace {

using namespace std::chrono_literals;
using config::Lamp;
namespace lamp = desk::lamp;

constexpr auto kAnswer = 5s;  ///< patience with one connection
constexpr auto kPause = 2s;   ///< while the lamp warms up

const char* const kNotes =
    R"(on: on, with the shutter open. mute: on, with the shutter closed. The projector is that of projector.lamp.pjlink.
If the rig is up, light.lamp becomes what was asked for.)";

struct Options {
  std::optional<Lamp> wanted;  ///< empty: how it is
  std::string rig, file;
  double wait_s = 120;
};

Result<void> read_wanted(const std::string& word, Options& options) {
  options.wanted = config::choice_named<Lamp>(word);
  if (word == "status" || (options.wanted && *options.wanted != Lamp::unchanged)) return {};
  return fail(Errc::bad_config, "write on, off, mute or status, not " + quote(word));
}

int complain(const Error& error) {
  fmt::print(stderr, "handcast lamp: {}\n", printable(error.what));
  return exit_code_of(error);
}

void print_status(const lamp::Status& status) {
  std::vector<std::string> lines{fmt::format("lamp       {}{}", lamp::words_for(status.power),
                                             status.is_muted ? ", the shutter is closed" : "")};
  if (!status.name.empty()) lines.insert(lines.begin(), "projector  " + status.name);
  if (!status.input.empty()) lines.push_back("input      " + status.input);
  for (const auto& each : status.lamps) lines.push_back(fmt::format("hours      {}", each.hours));
  lines.push_back("faults     " + (status.faults.empty() ? "none" : join(status.faults, ", ")));
  for (const auto& line : lines) fmt::print("{}\n", printable(line));
}

/// Until the lamp is so. Errors: those of lamp::tell().
Result<void> turn(const lamp::Place& place, Lamp wanted, const std::string& input,
                  Deadline patience) {
  for (bool has_said = false;;) {
    const auto done = lamp::tell(place, wanted, input, Deadline::in(kAnswer));
    if (!done) return tl::make_unexpected(done.error());
    if (*done) return {};
    if (patience.passed())
      return fail(Errc::timeout, "the lamp still warms up or cools down; `handcast lamp` tells");
    if (!std::exchange(has_said, true)) fmt::print("the lamp warms up or cools down …\n");
    sleep_until_ns(now_ns() + to_ns(kPause));
  }
}

int run(const Options& options) {
  std::optional<config::LiveBoard> board;
  config::ProjectorLamp settings;
  if (options.file.empty()) {
    auto opened = config::LiveBoard::open(options.rig);
    if (!opened)
      return complain({opened.error().code,
                       opened.error().what + "; `handcast lamp --file RIG.toml` needs no rig"});
    board = std::move(*opened);
    settings = board->filed().projector.lamp;
  } else {
    const auto rig = config::load_rig(options.file);
    if (!rig) return complain(rig.error());
    settings = rig->projector.lamp;
  }
  const auto place = lamp::place_of(settings);
  if (!place) return complain(place.error());
  if (!options.wanted) {
    const auto status = lamp::ask(*place, Deadline::in(kAnswer));
    if (!status) return complain(status.error());
    print_status(*status);
    return status->faults.empty() ? kExitDone : kExitBadResult;
  }
  // First, as the desk would turn it back.
  const std::vector<std::string> change{
      fmt::format("light.lamp={}", config::word_of(*options.wanted))};
  if (board)
    if (const auto set = board->set(change, "command line"); !set) return complain(set.error());
  const auto turned = turn(*place, *options.wanted, settings.input,
                           Deadline::at_ns(now_ns() + seconds_to_ns(options.wait_s)));
  return turned ? kExitDone : complain(turned.error());
}

}  // namespace
}  // namespace handcast::lamp

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  lamp::Options options;
  CommandLine line("handcast lamp", "Turns the lamp of the projector on or off by PJLink.",
                   lamp::kNotes);
  line.add(
      "[on|off|mute|status]",
      [&](const std::string& word) { return lamp::read_wanted(word, options); },
      "What it is told; status: how it is");
  line.add("--rig NAME", options.rig, "Which rig, if several are up");
  line.add("--file RIG.toml", options.file, "The projector of a rig that is not up");
  line.add("--wait S", options.wait_s, "How long the lamp may take", {0, 600});
  if (const auto code = line.answered(argc, argv)) return *code;
  return lamp::run(options);
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast lamp", argc, argv, run_verb);
}
