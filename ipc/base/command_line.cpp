// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/home.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "ipc/base/version.hpp"

namespace handcast {
namespace {

std::vector<std::string> split(const std::string& text, char divider) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, divider);) parts.push_back(part);
  return parts;
}

/// "  --json    The same as JSON", in lines of 100 columns.
std::string help_lines(const std::string& usage, const std::string& help) {
  constexpr std::size_t kIndent = 24, kColumns = 100;
  auto text = fmt::format("  {:<{}}", usage, kIndent - 3);
  std::size_t column = text.size() < kIndent ? text.size() : kColumns;
  for (const auto& word : split(help, ' ')) {
    if (column + 1 + word.size() > kColumns) {
      text += "\n" + std::string(kIndent - 1, ' ');
      column = kIndent - 1;
    }
    text += " " + word;
    column += 1 + word.size();
  }
  return text + "\n";
}

Result<double> parse_number(const std::string& text, CommandLine::Range range, bool is_whole) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (is_number && number >= range.least && number <= range.most &&
      (!is_whole || number == std::floor(number)))
    return number;
  const auto meant = is_number ? "" : meant_number(text);
  return fail(Errc::bad_config, fmt::format("{} is not a {} in the range {} to {}{}{}", quote(text),
                                            is_whole ? "whole number" : "number", range.least,
                                            range.most, meant.empty() ? "" : "; ", meant));
}

}  // namespace

bool CommandLine::Argument::takes(std::string_view name) const {
  return !is_word && std::ranges::count(names, name) > 0;
}

void CommandLine::add(std::string usage, Setter set, std::string help) {
  Argument argument{usage, {}, "", std::move(set), std::move(help), usage[0] != '-'};
  if (argument.is_word) argument.names = {usage.substr(0, usage.find("..."))};
  for (auto& part : split(argument.is_word ? "" : usage, ' '))
    if (part[0] == '-')
      argument.names.push_back(part.substr(0, part.find(',')));
    else
      argument.value = part;
  arguments_.push_back(std::move(argument));
}

void CommandLine::add(std::string usage, bool& given, std::string help) {
  const auto set = [&given](const std::string&) { return given = true, Result<void>(); };
  add(std::move(usage), Setter(set), std::move(help));
}

void CommandLine::add_number(std::string usage, std::function<void(double)> set, std::string help,
                             const Number& number) {
  const auto& range = number.range;
  help += fmt::format(" ({} to {}", range.least, range.most);
  if (number.usual >= range.least && number.usual <= range.most)
    help += fmt::format("; default: {}", number.usual);
  const auto parse = [number, set = std::move(set)](const std::string& text) {
    return parse_number(text, number.range, number.is_whole).map(set);
  };
  add(std::move(usage), Setter(parse), help + ")");
}

/// A shell puts the home folder in the place of ~ only at the start of a word: not in "--out=~/a".
Result<void> CommandLine::take(Argument& argument, const std::string& written) const {
  const auto value = expand_home(written).value_or(written);
  argument.is_given = true;
  const auto choices = split(argument.value, '|');
  auto set = choices.size() < 2 || std::ranges::count(choices, value) > 0
                 ? argument.set(value)
                 : fail(Errc::bad_config,
                        fmt::format("{} is not one of {}", quote(value), join(choices, ", ")));
  if (!set) return refusal(fmt::format("{}: {}", argument.names.back(), set.error().what));
  return set;
}

Result<void> CommandLine::take_word(const std::string& word) {
  for (auto& each : arguments_)
    if (each.is_word && (!each.is_given || each.usage.find("...") != std::string::npos))
      return take(each, word);
  return refusal(quote(word) + " is one argument too many");
}

/// Takes the option at `at`, which then is the place of its value.
Result<void> CommandLine::take_option(const std::vector<std::string>& arguments, std::size_t& at) {
  const auto& word = arguments[at];
  const bool is_long = word.starts_with("--");
  const auto name = word.substr(0, is_long ? word.find('=') : 2);
  const auto option =
      std::ranges::find_if(arguments_, [&](const auto& each) { return each.takes(name); });
  if (option == arguments_.end()) {
    std::vector<std::string_view> known{"--help", "--version"};
    for (const auto& each : arguments_)
      if (!each.is_word && !each.help.empty() && each.names.back().size() > 2)
        known.push_back(each.names.back());
    return refusal(fmt::format("unknown option {}{}", quote(word),
                               suggest(word.substr(0, word.find('=')), known)));
  }
  const bool is_joined = name.size() < word.size();
  if (option->value.empty() && is_joined) return refusal(name + " takes no value");
  if (option->value.empty()) return take(*option, "");
  const auto value = is_joined                 ? word.substr(name.size() + (is_long ? 1 : 0))
                     : ++at < arguments.size() ? arguments[at]
                                               : std::string();
  return value.empty() ? refusal(name + " needs a value") : take(*option, value);
}

Result<std::string> CommandLine::parse(const std::vector<std::string>& arguments) {
  bool has_options = true;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto& argument = arguments[i];
    if (argument.empty()) return refusal("an argument is empty");
    const bool is_option = has_options && argument.size() > 1 && argument[0] == '-';
    if (is_option && (argument == "-h" || argument == "--help")) return help();
    if (is_option && argument == "--version") return fmt::format("{} {}\n", name_, version());
    if (is_option && argument == "--") {
      has_options = false;
      continue;
    }
    const auto taken = is_option ? take_option(arguments, i) : take_word(argument);
    if (!taken) return tl::make_unexpected(taken.error());
  }
  for (const auto& each : arguments_)
    if (each.is_word && !each.is_given && each.usage[0] != '[')
      return refusal(each.names.back() + " is missing");
  return std::string();
}

std::string CommandLine::help() const {
  auto usage = fmt::format("usage: {}", name_);
  std::string words, options;
  for (const auto& each : arguments_) {
    if (each.is_word) usage += " " + each.usage;
    if (!each.help.empty()) (each.is_word ? words : options) += help_lines(each.usage, each.help);
  }
  options +=
      help_lines("-h, --help", "Prints this text") + help_lines("--version", "Prints the version");
  return fmt::format("{} [options]\n\n{}\n\n{}{}{}", usage, purpose_, words, options,
                     notes_.empty() ? "" : "\n" + notes_ + "\n");
}

tl::unexpected<Error> CommandLine::refusal(std::string_view sentence) const {
  constexpr std::string_view kVerb = "handcast ";
  const auto usage =
      name_.starts_with(kVerb) ? "handcast help " + name_.substr(kVerb.size()) : name_ + " --help";
  return fail(Errc::bad_config, fmt::format("{}; `{}`", sentence, usage));
}

int CommandLine::refuse(std::string_view sentence) const {
  return *handcast::answered(name_, Result<std::string>(refusal(sentence)));
}

std::optional<int> CommandLine::answered(const std::vector<std::string>& arguments) {
  return handcast::answered(name_, parse(arguments));
}

std::optional<int> answered(std::string_view program, const Result<std::string>& parsed) {
  if (parsed && parsed->empty()) return std::nullopt;
  if (parsed) return fmt::print("{}", *parsed), kExitDone;
  const auto line = fmt::format("{}: {}\n", program, printable(parsed.error().what));
  return log::put(log::for_journal(log::Level::error, line)), kExitUsage;
}

std::vector<std::string> CommandLine::given() const {
  std::vector<std::string> names;
  for (const auto& each : arguments_)
    if (!each.is_word && each.is_given) names.push_back(each.names.back());
  return names;
}

bool CommandLine::has(std::string_view option) const {
  return std::ranges::count(given(), option) > 0;
}

}  // namespace handcast
