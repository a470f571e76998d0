// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/prompt.hpp"

#include <fmt/format.h>

#include <charconv>
#include <istream>
#include <ostream>

#include "ipc/base/log.hpp"
#include "ipc/base/text.hpp"

namespace handcast::init {
namespace {

constexpr int kMostTries = 3;

/// The word of the option with this number; other answers are words already.
std::string word_of(const Question& question, const std::string& answer) {
  std::size_t number = 0;
  const auto* const end = answer.data() + answer.size();
  const auto read = std::from_chars(answer.data(), end, number);
  if (read.ec != std::errc{} || read.ptr != end || number < 1 || number > question.options.size())
    return answer;
  return question.options[number - 1].word;
}

/// What stands in brackets: the preset, or its number.
std::string shown_preset(const Question& question) {
  for (std::size_t i = 0; i < question.options.size(); ++i)
    if (question.options[i].word == question.preset) return fmt::format("{}", i + 1);
  return question.preset;
}

}  // namespace

Result<std::string> Prompt::read_answer(const Question& question) {
  out_ << printable(fmt::format("[{}] > ", shown_preset(question))) << std::flush;
  std::string line;
  if (!std::getline(in_, line)) {
    out_ << '\n';
    return fail(Errc::bad_config,
                fmt::format("the input ended before the answer to '{}'; {} answers it, --yes takes "
                            "the best guesses",
                            question.text, question.flag));
  }
  const std::string answer(trimmed(line));
  return answer.empty() ? question.preset : word_of(question, answer);
}

Result<void> Prompt::ask(const Question& question) {
  out_ << printable(question.text) << '\n';
  for (std::size_t i = 0; i < question.options.size(); ++i)
    out_ << printable(fmt::format("  {}  {}\n", i + 1, question.options[i].text));
  std::string refusal;
  for (int i = 0; i < kMostTries; ++i) {
    const auto answer = read_answer(question);
    if (!answer) return tl::make_unexpected(answer.error());
    const auto taken = question.take(*answer);
    if (taken) return {};
    refusal = taken.error().what;
    out_ << printable(fmt::format("  {}\n", refusal));
  }
  return fail(Errc::bad_config, fmt::format("no answer to '{}': {}; {} answers it, too",
                                            question.text, refusal, question.flag));
}

Result<void> settle(const Question& question, const std::optional<std::string>& flag,
                    Prompt* prompt) {
  if (flag) {
    auto taken = question.take(*flag);
    return taken ? taken : fail_in(question.flag, taken.error());
  }
  if (prompt == nullptr || question.options.size() == 1) return question.take(question.preset);
  return prompt->ask(question);
}

}  // namespace handcast::init
