// SPDX-License-Identifier: Apache-2.0
// The `handcast` command. Like git, it runs its own verbs and executes the program handcast-VERB
// for all others.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "ipc/base/join.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "ipc/base/version.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/succession/descriptor_store.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::array kGroups{
    std::pair{VerbGroup::run, "run a rig"}, std::pair{VerbGroup::look, "observe a running rig"},
    std::pair{VerbGroup::change, "change a running rig"},
    std::pair{VerbGroup::set_up, "set up a rig"}, std::pair{VerbGroup::score, "score a rig"}};

void print_overview() {
  fmt::print("handcast {} — light that stays on moving hands\n\nusage: handcast VERB ...\n",
             version());
  for (const auto& [group, title] : kGroups) {
    fmt::print("\n{}\n", title);
    for (const auto& verb : verbs())
      if (verb.group == group) fmt::print("  {:<14} {}\n", verb.name, verb.sentence);
  }
  fmt::print(
      "\n`handcast help VERB` prints the usage of a verb. First steps, also without any device:\n"
      "  handcast init        writes rig.toml for what is attached, or else for the digital twin\n"
      "  handcast up rig.toml runs it; in a second terminal, `handcast preview` shows it\n");
}

/// Executes handcast-VERB in place of this process. Returns only if there is no such program.
int become_program(const std::string& verb, const Arguments& arguments) {
  const bool plain = verb.find('/') == std::string::npos;
  const auto program = (program_folder() / ("handcast-" + verb)).string();
  if (plain && access(program.c_str(), X_OK) == 0) {
    std::vector<char*> pointers{const_cast<char*>(program.c_str())};
    for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    execv(program.c_str(), pointers.data());
  }
  if (find_verb(verb))
    return complain(
        kExitConfig,
        fmt::format("the program of this verb, {}, is missing; `scripts/build` builds all, and the "
                    "packages handcast-tools and handcast-lab have what handcast has not",
                    program));
  std::vector<std::string_view> names;
  for (const auto& each : verbs()) names.push_back(each.name);
  const auto nearest = suggest(verb, names);
  return complain(kExitUsage, fmt::format("there is no verb {}{}; there are: {}", quote(verb),
                                          nearest, join(names, ", ")));
}

int dispatch(const std::string& name, const Arguments& arguments);

int help(const Arguments& arguments) {
  if (arguments.empty()) {
    print_overview();
    return kExitDone;
  }
  const auto& about = arguments.front();
  if (about == "help" || about == "version") return dispatch(about, {});
  const auto verb = find_verb(about);
  return verb && verb->run ? verb->run({"--help"}) : become_program(about, {"--help"});
}

int dispatch(const std::string& name, const Arguments& arguments) {
  if (name == "help" || name == "--help" || name == "-h") return help(arguments);
  if (name == "version" || name == "--version" || name == "-V") {
    fmt::print("handcast {}\n{}", version(), absent_features());
    return kExitDone;
  }
  const auto verb = find_verb(name);
  return verb && verb->run ? verb->run(arguments) : become_program(name, arguments);
}

}  // namespace
}  // namespace handcast::supervisor

int main(int argc, char** argv) {
  using namespace handcast::supervisor;
  const auto run_verb = [](int count, char** words) {
    if (count >= 2 && words[1] == std::string_view(kHoldOption)) hold_descriptors();
    if (count >= 2) return dispatch(words[1], Arguments(words + 2, words + count));
    print_overview();
    return handcast::kExitUsage;
  };
  return handcast::run_program("handcast", argc, argv, run_verb);
}
