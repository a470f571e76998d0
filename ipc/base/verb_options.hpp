// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/suggest.hpp"
#include "ipc/base/verb_help.hpp"
#include "ipc/base/version.hpp"

namespace handcast {

/// What is wrong with an argument that no option and no positional takes.
inline std::string not_taken(const CLI::App& app) {
  auto rest = app.remaining();
  std::erase(rest, "--");
  const auto wrong = std::ranges::find_if(rest, [](const auto& word) { return word[0] == '-'; });
  if (wrong == rest.end())
    return rest.empty() ? "an argument is empty"
                        : fmt::format("'{}' is one argument too many", rest.front());
  std::vector<std::string> names;
  for (const auto* option : app.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return fmt::format("unknown option '{}'{}", *wrong,
                     suggest(wrong->substr(0, wrong->find('=')), {names.begin(), names.end()}));
}

/// CLI11's sentence about a value, "--after: Value x not in range 0.1 to 3600" or "--shot: 1
/// required TEXT missing", for a person.
inline std::string about_value(std::string_view sentence) {
  const auto colon = sentence.find(": ");
  constexpr std::string_view kValue = ": Value ", kRange = " not in range ";
  const auto range = sentence.find(kRange);
  if (colon != sentence.npos && sentence.ends_with(" missing"))
    return fmt::format("{} needs a value", sentence.substr(0, colon));
  if (colon == sentence.npos || range == sentence.npos ||
      !sentence.substr(colon).starts_with(kValue))
    return std::string(sentence);
  const auto value = sentence.substr(colon + kValue.size(), range - colon - kValue.size()),
             limits = sentence.substr(range + kRange.size());
  // CLI11 prints the limits of whole numbers without a point.
  const bool is_whole = limits.find('.') == limits.npos;
  return fmt::format("{}: '{}' is not a {} in the range {}", sentence.substr(0, colon), value,
                     is_whole ? "whole number" : "number",
                     spoken_range(std::string(limits), " to "));
}

/// Parses the command line of a program, whose options `app` has; adds --version. Returns the text
/// that --help or --version asks for; "" if the program shall run. Errors: bad_config, with a
/// sentence that names the option and says where its usage is.
inline Result<std::string> parse_options(CLI::App& app, int argc, char** argv) {
  app.set_version_flag("--version", fmt::format("{} {}\n", app.get_name(), version()));
  app.formatter(std::make_shared<VerbHelp>());
  const auto refuse = [&](const std::string& sentence) {
    constexpr std::string_view kProgram = "handcast ";
    const auto& name = app.get_name();
    const auto usage = name.starts_with(kProgram) ? "handcast help " + name.substr(kProgram.size())
                                                  : name + " --help";
    return fail(Errc::bad_config, fmt::format("{}; `{}`", sentence, usage));
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return app.help();
  } catch (const CLI::CallForVersion& call) {
    return std::string(call.what());
  } catch (const CLI::ExtrasError&) {
    return refuse(not_taken(app));
  } catch (const CLI::RequiredError& problem) {
    // A mistyped option is why it is missing, or the better hint.
    const auto rest = app.remaining();
    const bool is_mistyped = std::ranges::any_of(
        rest, [](const auto& word) { return word.size() > 1 && word[0] == '-' && word != "--"; });
    return refuse(is_mistyped ? not_taken(app) : problem.what());
  } catch (const CLI::ParseError& problem) {
    return refuse(about_value(problem.what()));
  }
  return std::string();
}

/// The exit code of a program that parse_options() has answered with a text or an error, which are
/// printed; empty if it shall run.
inline std::optional<int> answered(const CLI::App& app, const Result<std::string>& text) {
  if (!text) {
    fmt::print(stderr, "{}: {}\n", app.get_name(), text.error().what);
    return kExitUsage;
  }
  if (text->empty()) return std::nullopt;
  fmt::print("{}", *text);
  return kExitDone;
}

}  // namespace handcast
