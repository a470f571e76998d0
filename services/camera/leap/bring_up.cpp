// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/bring_up.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <sstream>

#include "ipc/base/quote.hpp"
#include "services/camera/leap/shipped_files.hpp"

namespace handcast::camera::leap {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;  ///< of a file
constexpr std::size_t kMostData = 4096;      ///< of a transfer
constexpr unsigned kMostPause_ms = 1000;
constexpr std::int64_t kMostPauses_ns = 10'000'000'000;  ///< in all
constexpr std::size_t kMostFaults = 20;

using Words = std::vector<std::string_view>;

Words words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  Words words;
  constexpr std::string_view kSpace = " \t\r";
  while (true) {
    const auto begin = line.find_first_not_of(kSpace);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    words.push_back(line.substr(0, line.find_first_of(kSpace)));
    line.remove_prefix(words.back().size());
  }
}

/// A number in [0, most]. Errors: bad_config.
Result<unsigned> number(std::string_view word, unsigned most, int base = 16) {
  auto digits = word;
  if (base == 16 && (digits.starts_with("0x") || digits.starts_with("0X"))) digits.remove_prefix(2);
  unsigned value = 0;
  const auto [end, fault] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  if (fault == std::errc() && end == digits.data() + digits.size() && value <= most) return value;
  const auto largest = base == 16 ? fmt::format("{:x}", most) : fmt::format("{}", most);
  return fail(Errc::bad_config, fmt::format("{} is not a {} number from 0 to {}", quote(word),
                                            base == 16 ? "hexadecimal" : "decimal", largest));
}

/// The numbers behind the first word: the first ones up to `limits`, all others bytes.
Result<std::vector<unsigned>> numbers(const Words& words, std::initializer_list<unsigned> limits) {
  std::vector<unsigned> values;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto value = number(words[i], i <= limits.size() ? limits.begin()[i - 1] : 0xff);
    if (!value) return tl::make_unexpected(value.error());
    values.push_back(*value);
  }
  return values;
}

ControlTransfer transfer_with(const std::vector<unsigned>& values) {
  return {static_cast<std::uint8_t>(values[0]), static_cast<std::uint8_t>(values[1]),
          static_cast<std::uint16_t>(values[2]), static_cast<std::uint16_t>(values[3])};
}

Result<ControlTransfer> write_of(const Words& words) {
  const auto values = numbers(words, {0x7f, 0xff, 0xffff, 0xffff});
  if (!values) return tl::make_unexpected(values.error());
  if (values->size() < 4 || values->size() > 4 + kMostData)
    return fail(Errc::bad_config, "`write` is followed by type, request, value, index and bytes");
  auto transfer = transfer_with(*values);
  transfer.data.assign(values->begin() + 4, values->end());
  transfer.length = static_cast<std::uint16_t>(transfer.data.size());
  return transfer;
}

Result<ControlTransfer> read_of(const Words& words) {
  const auto values = numbers(words, {0xff, 0xff, 0xffff, 0xffff, kMostData});
  if (!values) return tl::make_unexpected(values.error());
  if (values->size() != 5 || (*values)[0] < 0x80)
    return fail(Errc::bad_config,
                "`read` is followed by type (80 or more), request, value, index and length");
  auto transfer = transfer_with(*values);
  transfer.length = static_cast<std::uint16_t>((*values)[4]);
  return transfer;
}

Result<ControlTransfer> set_of(const Words& words) {
  const auto values = numbers(words, {0xff, 0xff, 0xffff});
  if (!values) return tl::make_unexpected(values.error());
  if (values->size() != 3)
    return fail(Errc::bad_config, "`set` is followed by unit, selector and value");
  return set_control(
      {static_cast<std::uint8_t>((*values)[0]), static_cast<std::uint8_t>((*values)[1])},
      static_cast<std::uint16_t>((*values)[2]));
}

/// Reads one line into the sequence, or into the pause before its next step.
Result<void> read_line(const Words& words, int line, std::int64_t& pause_ns,
                       std::vector<BringUpStep>& steps) {
  const auto verb = words.front();
  if (verb == "pause") {
    if (words.size() != 2) return fail(Errc::bad_config, "`pause` is followed by milliseconds");
    const auto pause_ms = number(words[1], kMostPause_ms, 10);
    if (!pause_ms) return tl::make_unexpected(pause_ms.error());
    pause_ns += std::int64_t{1'000'000} * *pause_ms;
    return {};
  }
  const auto read = verb == "write"  ? write_of
                    : verb == "read" ? read_of
                    : verb == "set"  ? set_of
                                     : nullptr;
  if (!read)
    return fail(Errc::bad_config, quote(verb) + " is no step; there are: write, read, set, pause");
  const auto transfer = read(words);
  if (!transfer) return tl::make_unexpected(transfer.error());
  steps.push_back({pause_ns, *transfer, line});
  pause_ns = 0;
  return {};
}

}  // namespace

Result<std::vector<BringUpStep>> parse_bring_up(std::string_view text, std::string_view file) {
  std::vector<BringUpStep> steps;
  std::string faults;
  std::size_t fault_count = 0;
  std::int64_t pause_ns = 0;
  for (int line = 1; !text.empty() && fault_count < kMostFaults; ++line) {
    const auto end = text.find('\n');
    const auto words = words_of(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (words.empty()) continue;
    if (const auto read = read_line(words, line, pause_ns, steps); !read)
      faults +=
          fmt::format("{}{}:{}: {}", fault_count++ ? "\n" : "", file, line, read.error().what);
  }
  std::int64_t all_ns = pause_ns;
  for (const auto& step : steps) all_ns += step.pause_ns;
  if (all_ns > kMostPauses_ns) {
    faults +=
        fmt::format("{}{}: the pauses are {} s in all; at most {} s", fault_count++ ? "\n" : "",
                    file, all_ns / 1'000'000'000, kMostPauses_ns / 1'000'000'000);
  }
  if (fault_count > 0) return fail(Errc::bad_config, faults);
  return steps;
}

Result<std::vector<BringUpStep>> load_bring_up(const std::filesystem::path& file) {
  if (file.empty()) return parse_bring_up(kBringUp, "bring_up.txt");
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code))
    return fail(Errc::bad_config, fmt::format("'{}' is not a file", file.string()));
  if (std::filesystem::file_size(file, code) > kMostBytes || code)
    return fail(Errc::bad_config,
                fmt::format("'{}' is too long for a bring-up sequence", file.string()));
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf()))
    return fail(Errc::bad_config, fmt::format("'{}' cannot be read, or is empty", file.string()));
  return parse_bring_up(text.str(), file.string());
}

}  // namespace handcast::camera::leap
