// SPDX-License-Identifier: Apache-2.0
#include "services/watch/day.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ipc/base/input_file.hpp"

namespace handcast::watch {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kFormat = 1;
constexpr std::size_t kMostEvents = 500;
constexpr int kMostTenths = 10'000;  ///< of a millisecond: later light counts as this late

std::string local_text(std::time_t time, const char* format) {
  std::tm local{};
  ::localtime_r(&time, &local);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &local)};
}

}  // namespace

// In the namespace of the types, where the library looks for them.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Latencies, counts, worst_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Fault, kind, sentence, since, until, black_box, told)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Event, time, text)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Drift, moved, across_mm, turn_deg)

void Latencies::add(double latency_ms) {
  worst_ms = std::max(worst_ms, latency_ms);
  ++counts[static_cast<int>(std::clamp(latency_ms * 10, 0.0, double{kMostTenths}))];
}

double Latencies::quantile_ms(double share) const {
  std::uint64_t all = 0, so_far = 0;
  for (const auto& [tenths, count] : counts) all += count;
  for (const auto& [tenths, count] : counts) {
    so_far += count;
    if (static_cast<double>(so_far) >= share * static_cast<double>(all)) return 0.1 * tenths;
  }
  return 0;
}

void Day::note(std::time_t time, std::string text) {
  if (events.size() >= kMostEvents) events.erase(events.begin());
  events.push_back({clock_of(time), std::move(text)});
}

Fault* Day::open_fault(const std::string& kind) {
  const auto found = std::ranges::find_if(
      faults, [&](const Fault& fault) { return fault.kind == kind && fault.until.empty(); });
  return found == faults.end() ? nullptr : &*found;
}

void Day::go_on_from(const Day& before) {
  drift = before.drift;
  rig_started_ns = before.rig_started_ns;
  counted_until = 0;
  counted = before.counted;
  lights = before.lights;
  alerted = before.alerted;
}

Day Day::next(const std::string& next_date) const {
  Day day;
  day.rig = rig;
  day.date = next_date;
  std::ranges::copy_if(faults, std::back_inserter(day.faults),
                       [](const Fault& fault) { return fault.until.empty(); });
  day.go_on_from(*this);
  return day;
}

std::string date_of(std::time_t time) { return local_text(time, "%Y-%m-%d"); }
std::string clock_of(std::time_t time) { return local_text(time, "%H:%M:%S"); }

std::size_t minute_of_day(std::time_t time) {
  std::tm local{};
  ::localtime_r(&time, &local);
  return static_cast<std::size_t>(local.tm_hour) * 60 + static_cast<std::size_t>(local.tm_min);
}

bool is_date(const std::string& text) {
  constexpr std::string_view kForm = "dddd-dd-dd";
  return std::ranges::equal(text, kForm, [](char c, char form) {
    return form == 'd' ? c >= '0' && c <= '9' : c == form;
  });
}

fs::path folder_of(const config::Watch& settings, fs::path rig_file) {
  if (!settings.folder.empty()) return settings.folder;
  return rig_file.replace_extension(".watch");
}

fs::path json_file(const fs::path& folder, const std::string& date) {
  return folder / (date + ".json");
}
fs::path page_file(const fs::path& folder, const std::string& date) {
  return folder / (date + ".html");
}

std::string to_json(const Day& day) {
  json object{{"format", kFormat},
              {"rig", day.rig},
              {"date", day.date},
              {"up_s", std::round(day.up_s)},
              {"lit_s", std::round(day.lit_s)},
              {"dark_s", std::round(day.dark_s)},
              {"starts", day.starts},
              {"restarts", day.restarts},
              {"latency_ms",
               {{"usual", day.latencies.quantile_ms(0.5)},
                {"p99", day.latencies.quantile_ms(0.99)},
                {"worst", day.latencies.worst_ms}}},
              {"latencies", day.latencies},
              {"frames", day.frames},
              {"missed_refreshes", day.missed_refreshes},
              {"visits", day.visits},
              {"hands_s", day.hands_s},
              {"longest_visit_s", day.longest_visit_s},
              {"drift", day.drift ? json(*day.drift) : json()},
              {"disk_free_gb", day.disk_free_gb},
              {"disk_gb", day.disk_gb},
              {"faults", day.faults},
              {"events", day.events},
              {"minutes", day.minutes},
              {"state",
               {{"rig_started_ns", day.rig_started_ns},
                {"counted_until", day.counted_until},
                {"counted", day.counted},
                {"lights", day.lights ? json(*day.lights) : json()},
                {"alerted", day.alerted}}}};
  return object.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<Day> day_in(const std::string& text) try {
  const auto object = json::parse(text);
  if (object.at("format").get<int>() > kFormat)
    return fail(Errc::bad_data, "a newer version of handcast wrote it");
  Day day;
  const auto read = [](const json& from, const char* name, auto& member) {
    from.at(name).get_to(member);
  };
  read(object, "rig", day.rig);
  read(object, "date", day.date);
  read(object, "up_s", day.up_s);
  read(object, "lit_s", day.lit_s);
  read(object, "dark_s", day.dark_s);
  read(object, "starts", day.starts);
  read(object, "restarts", day.restarts);
  read(object, "latencies", day.latencies);
  read(object, "frames", day.frames);
  read(object, "missed_refreshes", day.missed_refreshes);
  read(object, "visits", day.visits);
  read(object, "hands_s", day.hands_s);
  read(object, "longest_visit_s", day.longest_visit_s);
  if (!object.at("drift").is_null()) day.drift = object.at("drift").get<Drift>();
  read(object, "disk_free_gb", day.disk_free_gb);
  read(object, "disk_gb", day.disk_gb);
  read(object, "faults", day.faults);
  read(object, "events", day.events);
  read(object, "minutes", day.minutes);
  day.minutes.resize(24 * 60, ' ');
  std::ranges::replace_if(
      day.minutes,
      [](char c) { return std::string_view(" ldf").find(c) == std::string_view::npos; }, ' ');
  const auto& state = object.at("state");
  read(state, "rig_started_ns", day.rig_started_ns);
  read(state, "counted_until", day.counted_until);
  read(state, "counted", day.counted);
  if (!state.at("lights").is_null()) day.lights = state.at("lights").get<bool>();
  read(state, "alerted", day.alerted);
  if (day.faults.size() > Day::kMostFaults) day.faults.resize(Day::kMostFaults);
  return day;
} catch (const json::exception& fault) {
  return fail(Errc::bad_data, fault.what());
}

Result<std::optional<Day>> load_day(const fs::path& folder, const std::string& date) {
  const auto file = json_file(folder, date);
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return std::nullopt;
  const auto text = read_input(file, kMostText);
  if (!text) return tl::make_unexpected(text.error());
  auto day = day_in(*text);
  if (!day) return fail(Errc::bad_data, fmt::format("{}: {}", file.string(), day.error().what));
  return std::move(*day);
}

std::vector<std::string> dates_in(const fs::path& folder) {
  std::vector<std::string> dates;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent))
    if (entry.path().extension() == ".json" && is_date(entry.path().stem().string()))
      dates.push_back(entry.path().stem().string());
  std::ranges::sort(dates);
  return dates;
}

void keep_days(const fs::path& folder, int most) {
  auto dates = dates_in(folder);
  const auto kept = std::min(dates.size(), static_cast<std::size_t>(most));
  dates.resize(dates.size() - kept);
  std::error_code absent;
  for (const auto& date : dates) {
    fs::remove(json_file(folder, date), absent);
    fs::remove(page_file(folder, date), absent);
  }
}

}  // namespace handcast::watch
