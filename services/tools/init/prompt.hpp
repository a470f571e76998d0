// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::init {

/// An answer to choose: the word that means it, and what a person reads.
struct Option {
  std::string word, text;
};

/// A question about a rig.
struct Question {
  std::string flag;             ///< that answers it, too: "--camera"
  std::string text;             ///< "Which camera?"
  std::vector<Option> options;  ///< numbered from 1; empty: any answer
  std::string preset;  ///< the answer without one; the word of an option, if it has options
  /// Keeps an answer. Errors: bad_config, unavailable (the answer cannot be taken, and why).
  std::function<Result<void>(const std::string&)> take;
};

/// Asks a person, line by line.
class Prompt {
 public:
  /// `in`, `out`: must outlive this object.
  Prompt(std::istream& in, std::ostream& out) : in_(in), out_(out) {}

  /// Asks until an answer is taken, three times at most. An empty line takes the preset, a number
  /// the option. Errors: bad_config (the input ended, or no answer could be taken).
  Result<void> ask(const Question& question);

 private:
  Result<std::string> read_answer(const Question& question);

  std::istream& in_;
  std::ostream& out_;
};

/// Answers a question by its flag; otherwise by its preset, if there is nobody to ask (`prompt` is
/// null) or only one answer; otherwise by asking. Errors: those of Question::take, after the name
/// of the flag, and of Prompt::ask().
Result<void> settle(const Question& question, const std::optional<std::string>& flag,
                    Prompt* prompt);

}  // namespace handcast::init
