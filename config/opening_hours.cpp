// SPDX-License-Identifier: Apache-2.0
#include "config/opening_hours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "ipc/base/quote.hpp"
#include "ipc/base/text.hpp"

namespace handcast::config {
namespace {

constexpr int kDay_min = 24 * 60;
constexpr std::array<std::string_view, 7> kDays{"sun", "mon", "tue", "wed", "thu", "fri", "sat"};

/// Takes what is before a separator, or all, off the front of a text.
std::string_view take_part(std::string_view& text, std::string_view separator) {
  const auto end = std::min(text.find(separator), text.size());
  const auto part = text.substr(0, end);
  text.remove_prefix(std::min(end + separator.size(), text.size()));
  return part;
}

/// A number of this many digits from 0 to `most`.
std::optional<int> number(std::string_view text, std::size_t digits, int most) {
  int value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = fault == std::errc() && end == text.data() + text.size();
  if (text.size() != digits || !is_whole || value < 0 || value > most) return std::nullopt;
  return value;
}

/// Minutes of "10:00"; "24:00" is the end of the day.
std::optional<int> minutes_of(std::string_view text) {
  const auto hours = number(take_part(text, ":"), 2, 24), minutes = number(text, 2, 59);
  if (!hours || !minutes || *hours * 60 + *minutes > kDay_min) return std::nullopt;
  return *hours * 60 + *minutes;
}

/// The date of "2026-12-24" or, with the year 0, "12-24".
std::optional<int> date_of(std::string_view text) {
  const auto parts = std::ranges::count(text, '-');
  if (parts != 1 && parts != 2) return std::nullopt;
  const auto year = parts == 2 ? number(take_part(text, "-"), 4, 9999) : 0;
  const auto month = number(take_part(text, "-"), 2, 12), day = number(text, 2, 31);
  constexpr std::array kLengths{31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (!year || !month || !day || *month < 1 || *day < 1 ||
      *day > kLengths[static_cast<std::size_t>(*month) - 1])
    return std::nullopt;
  return *year * 10000 + *month * 100 + *day;
}

std::optional<std::size_t> weekday_of(std::string_view text) {
  const auto found = std::ranges::find(kDays, text);
  if (found == kDays.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kDays.begin());
}

std::tm local(std::time_t time) {
  std::tm day{};
  ::localtime_r(&time, &day);
  return day;
}

}  // namespace

/// The parts of a sentence. Each is empty if it is wrong.
struct OpeningHours::Reader {
  static std::optional<Ranges> ranges(std::string_view text) {
    Ranges ranges;
    if (text == "closed") return ranges;
    while (!text.empty()) {
      auto part = trimmed(take_part(text, ","));
      const auto begin = minutes_of(trimmed(take_part(part, "-"))), end = minutes_of(trimmed(part));
      if (!begin || !end || begin == end || *begin == kDay_min) return std::nullopt;
      ranges.push_back({*begin, *end < *begin ? *end + kDay_min : *end});
    }
    if (ranges.empty()) return std::nullopt;
    return ranges;
  }

  /// By std::tm::tm_wday.
  static std::optional<std::array<bool, 7>> days(std::string_view text) {
    std::array<bool, 7> chosen{};
    if (text == "daily") chosen.fill(true), text = {};
    while (!text.empty()) {
      auto part = take_part(text, ",");
      const bool is_span = part.find('-') != part.npos;
      const auto first = weekday_of(take_part(part, "-"));
      const auto last = is_span ? weekday_of(part) : first;
      if (!first || !last) return std::nullopt;
      for (auto day = *first;; day = (day + 1) % 7) {
        chosen[day] = true;
        if (day == *last) break;
      }
    }
    return chosen;
  }

  static std::optional<Dated> dates(std::string_view text) {
    const auto first = date_of(take_part(text, ".."));
    const auto last = text.empty() ? first : date_of(text);
    const bool is_span = first && last && (*first < 10000) == (*last < 10000);
    // Of each year, a span may pass New Year.
    if (!is_span || (*first >= 10000 && *last < *first)) return std::nullopt;
    return Dated{*first, *last, {}};
  }
};

Result<OpeningHours> OpeningHours::parse(std::span<const std::string> sentences) {
  OpeningHours hours;
  for (const auto& sentence : sentences) {
    auto text = trimmed(sentence);
    const auto when = take_part(text, " ");
    const auto days = Reader::days(when);
    auto dates = Reader::dates(when);
    auto ranges = Reader::ranges(trimmed(text));
    if (!ranges || (!days && !dates))
      return fail(Errc::bad_config,
                  fmt::format("{} says no hours: {}", quote(sentence),
                              ranges ? fmt::format("{} is no day (mon-fri, \"sat,sun\", daily) and "
                                                   "no date (2026-12-24, 12-24)",
                                                   quote(when))
                                     : "behind the day or date, write closed or a range of times "
                                       "of the day, e.g. 10:00-18:00"));
    if (dates) {
      dates->open = std::move(*ranges);
      hours.dated_.push_back(std::move(*dates));
      continue;
    }
    hours.has_days_ = true;
    for (std::size_t day = 0; day < 7; ++day)
      if ((*days)[day])
        hours.week_[day].insert(hours.week_[day].end(), ranges->begin(), ranges->end());
  }
  return hours;
}

const OpeningHours::Ranges& OpeningHours::ranges_on(const std::tm& day) const {
  static const Ranges kAllDay{{0, kDay_min}};
  const int of_year = (day.tm_mon + 1) * 100 + day.tm_mday;
  const int date = (day.tm_year + 1900) * 10000 + of_year;
  const Dated* found = nullptr;  // one of a year goes before one of each year
  for (const auto& each : dated_) {
    const bool is_yearly = each.first < 10000;
    const int at = is_yearly ? of_year : date;
    const bool fits = each.first <= each.last ? at >= each.first && at <= each.last
                                              : at >= each.first || at <= each.last;
    if (fits && (!found || !is_yearly)) found = &each;
  }
  if (found) return found->open;
  return has_days_ ? week_[static_cast<std::size_t>(day.tm_wday)] : kAllDay;
}

bool OpeningHours::is_open(std::time_t time) const {
  const auto today = local(time);
  const int minute = today.tm_hour * 60 + today.tm_min;
  auto noon = today;  // no clock is changed by half a day
  noon.tm_hour = 12;
  noon.tm_mday -= 1;
  noon.tm_isdst = -1;
  const auto yesterday = local(std::mktime(&noon));
  const auto covers = [](const Ranges& ranges, int at) {
    return std::ranges::any_of(
        ranges, [&](const Range& range) { return at >= range.begin && at < range.end; });
  };
  return covers(ranges_on(today), minute) || covers(ranges_on(yesterday), minute + kDay_min);
}

}  // namespace handcast::config
