// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast {

/// The command line of a program or a verb. Each argument is declared once, as the usage text shows
/// it: "RIG.toml", "[FILE]" (may be left out), "IMAGE..." (one or more), "[STEP...]", "--json",
/// "-o, --output FILE". An option takes its value as "--size 640x480", "--size=640x480" or "-j4".
/// After "--" there are no options. -h, --help and --version need no declaration.
class CommandLine {
 public:
  /// The smallest and the largest value of a number.
  struct Range {
    double least, most;
  };
  /// Takes a value. An error is a sentence without the name of the option.
  using Setter = std::function<Result<void>(const std::string& value)>;

  /// `name` is "handcast preview" or "handcast-camera"; `purpose` and `notes` stand above and below
  /// the arguments in the usage text.
  CommandLine(std::string name, std::string purpose, std::string notes = "")
      : name_(std::move(name)), purpose_(std::move(purpose)), notes_(std::move(notes)) {}

  /// Declares an argument. "--side left|right" accepts only these two values. An argument without
  /// help is not shown.
  void add(std::string usage, Setter set, std::string help);
  /// Declares an option without a value.
  void add(std::string usage, bool& given, std::string help);
  /// Declares a number in a range, which is shown, as is a default in the range.
  template <class Number>
  requires std::is_arithmetic_v<Number>
  // NOLINTNEXTLINE(performance-unnecessary-value-param): they are moved
  void add(std::string usage, Number& number, std::string help, Range range) {
    const auto set = [&number](double value) { number = static_cast<Number>(value); };
    add_number(std::move(usage), set, std::move(help),
               {range, static_cast<double>(number), std::is_integral_v<Number>});
  }
  /// Declares a text or a path, of which the last one given counts, or a list of them. A text that
  /// is not empty is shown as the default.
  template <class Text>
  requires(std::is_assignable_v<Text&, std::string>) void add(std::string usage, Text& text,
                                                              std::string help) {
    if constexpr (requires { text.empty(); })
      if (!text.empty()) help += " (default: " + std::string(text) + ")";
    const auto set = [&text](const std::string& value) { return text = value, Result<void>(); };
    add(std::move(usage), Setter(set), std::move(help));
  }
  template <class Text>
  void add(std::string usage, std::vector<Text>& list, std::string help) {
    if (usage[0] == '-') help += " (may be repeated)";
    const auto set = [&list](const std::string& value) {
      return list.emplace_back(value), Result<void>();
    };
    add(std::move(usage), Setter(set), std::move(help));
  }

  /// Parses the arguments without the program's name. Returns the text that --help or --version
  /// asks for; "" if the program shall run. Errors: bad_config, with a sentence that names the
  /// argument and the command that prints the usage.
  Result<std::string> parse(const std::vector<std::string>& arguments);
  Result<std::string> parse(int argc, const char* const* argv) {
    return parse({argv + 1, argv + argc});
  }
  /// The same; prints the text or the error. Returns the exit code; empty if the program shall run.
  std::optional<int> answered(const std::vector<std::string>& arguments);
  std::optional<int> answered(int argc, const char* const* argv) {
    return answered({argv + 1, argv + argc});
  }

  /// An error about the command line: the sentence, and the command that prints the usage.
  tl::unexpected<Error> refusal(std::string_view sentence) const;
  /// Prints the same. Returns kExitUsage.
  int refuse(std::string_view sentence) const;

  /// The options that were given, each by its last name: "--output".
  std::vector<std::string> given() const;
  /// True if the option with this last name was given.
  bool has(std::string_view option) const;

 private:
  struct Argument {
    std::string usage;               ///< "-o, --output FILE"
    std::vector<std::string> names;  ///< "-o", "--output"; of a word: "RIG.toml"
    std::string value;               ///< "FILE"; "" without a value
    Setter set;
    std::string help;
    bool is_word = false, is_given = false;

    bool takes(std::string_view name) const;
  };
  struct Number {
    Range range;
    double usual;
    bool is_whole;
  };

  void add_number(std::string usage, std::function<void(double)> set, std::string help,
                  const Number& number);
  Result<void> take_option(const std::vector<std::string>& arguments, std::size_t& at);
  Result<void> take_word(const std::string& word);
  Result<void> take(Argument& argument, const std::string& value) const;
  std::string help() const;

  std::string name_, purpose_, notes_;
  std::vector<Argument> arguments_;
};

/// Prints what CommandLine::parse() has returned to `program`. Returns the exit code; empty if the
/// program shall run.
std::optional<int> answered(std::string_view program, const Result<std::string>& parsed);

}  // namespace handcast
