// SPDX-License-Identifier: Apache-2.0
#include "services/watch/night_watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/daemon/contract.hpp"
#include "services/watch/report.hpp"

namespace handcast::watch {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::int64_t kLookEvery_ns = 1'000'000'000, kSaveEvery_ns = 60'000'000'000,
                       kTryAgain_ns = 10'000'000'000;
constexpr auto kPatience = 500ms;    ///< with a supervisor that hangs
constexpr double kGivesUp_s = 1800;  ///< a fault that lasts for so long does not go by itself
constexpr double kBytesPerGb = 1e9;

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown computer";
}

/// A day that was written; empty if there is none that can be read.
std::optional<Day> written_day(const fs::path& folder, const std::string& date) {
  auto day = load_day(folder, date);
  if (day) return std::move(*day);
  log::warning("the day begins anew: {}", day.error().what);
  std::error_code failed;  // it is kept for whoever wants to look at it
  const auto file = json_file(folder, date);
  fs::rename(file, file.string() + ".damaged", failed);
  return std::nullopt;
}

/// The day of a date that comes after `before`. It may have begun already: clocks are set.
Day day_on(const fs::path& folder, const std::string& date, const Day& before) {
  auto day = before.next(date);
  if (auto written = written_day(folder, date)) {
    day = std::move(*written);
    day.go_on_from(before);
  }
  return day;
}

/// The day that goes on, or that follows the newest one.
Day day_at(const fs::path& folder, const std::string& rig, std::time_t time) {
  Day newest;
  newest.rig = rig;
  const auto dates = dates_in(folder);
  if (!dates.empty())
    if (auto written = written_day(folder, dates.back())) newest = std::move(*written);
  const auto today = date_of(time);
  return newest.date == today ? newest : day_on(folder, today, newest);
}

}  // namespace

Moment Moment::now() { return {now_ns(), std::time(nullptr)}; }

Result<std::unique_ptr<NightWatch>> NightWatch::open(Rig rig, Lights lights, Moment now) {
  auto hours = config::OpeningHours::parse(rig.settings.watch.hours);
  if (!hours) return tl::make_unexpected(hours.error());
  auto folder = folder_of(rig.settings.watch, lights.rig_file());
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed)
    return fail(Errc::unavailable,
                fmt::format("the folder '{}' of the reports cannot be made: {}; watch.folder names "
                            "another",
                            folder.string(), failed.message()));
  auto day = day_at(folder, rig.settings.name, now.time);
  return std::unique_ptr<NightWatch>(new NightWatch(std::move(rig), std::move(lights),
                                                    std::move(*hours), std::move(folder),
                                                    std::move(day), now));
}

NightWatch::NightWatch(Rig rig, Lights lights, config::OpeningHours hours, fs::path folder, Day day,
                       Moment now)
    : rig_(std::move(rig)),
      settings_(rig_.settings.watch),
      lights_(std::move(lights)),
      hours_(std::move(hours)),
      folder_(std::move(folder)),
      day_(std::move(day)),
      tally_(day_, rig_.started_ns, now.ns, now.time),
      finder_(settings_.alert),
      book_(day_, settings_.alert),
      errands_({settings_.command_s, lights_.rig_file().parent_path(),
                [this](const std::string& failure) {
                  log::warning("{}", failure);
                  day_.note(std::time(nullptr), failure);
                }}),
      boxes_(folder_ / "faults", settings_.black_box.kept, rig_.settings, rig_.calibration) {
  for (const auto* stream : {"pose.hands", "landmarks.hands", "landmarks2.hands"}) track(stream);
  if (settings_.black_box.images && settings_.black_box.seconds > 0) track("camera.frames");
  if (tally_.rig_is_new() && settings_.alert.starts) alert("the rig was started\n");
}

void NightWatch::track(const std::string& stream) {
  if (!tracked_.insert(stream).second) return;
  auto ring = rig_.ring(stream);
  if (!ring) return;  // of a service that a reload has added
  auto opened =
      stream == "pose.hands"
          ? track_poses(std::move(*ring), [this](const auto& poses) { tally_.add(poses); })
      : stream == "camera.frames"       ? track_images(std::move(*ring))
      : stream.starts_with("landmarks") ? track_landmarks(std::move(*ring))
      : stream.starts_with("marks.projector")
          ? track_marks(std::move(*ring), [this](const auto& marks) { tally_.add(marks); })
          : track_marks(std::move(*ring), {});
  if (opened)
    tracks_.emplace_back(stream, std::move(*opened));
  else
    log::warning("{}: {}", stream, opened.error().what);
}

void NightWatch::turn(Moment now) {
  const auto since_ns = now.ns - seconds_to_ns(settings_.black_box.seconds);
  for (const auto& [stream, track] : tracks_) track->take(since_ns);
  errands_.turn(now.ns);
  if (now.ns < next_look_ns_) return;
  next_look_ns_ = now.ns + kLookEvery_ns;
  look(now);
}

void NightWatch::look(Moment now) {
  if (const auto date = date_of(now.time); date != day_.date) {
    save(Lasting::day);
    day_ = day_on(folder_, date, day_);
    save(Lasting::minute);
    keep_days(folder_, settings_.days);
  }
  follow_changes(now);
  follow_hours(now);
  ask_supervisor(now);
  tally_.pass(now.ns, now.time, {lights_.is_dark(), book_.has_open()});
  if (now.ns < next_save_ns_) return;
  ::tzset();  // the computer may have been told another time zone
  next_save_ns_ = now.ns + kSaveEvery_ns;
  save(Lasting::minute);
}

void NightWatch::follow_changes(Moment now) {
  if (const auto change = lights_.look())
    changes_.push_back(
        {now.ns, fmt::format("{} {}: {}\n", clock_of(now.time), change->source, change->what)});
  const auto since_ns = now.ns - seconds_to_ns(settings_.black_box.seconds);
  while (!changes_.empty() && changes_.front().time_ns < since_ns) changes_.pop_front();
}

void NightWatch::follow_hours(Moment now) {
  if (hours_.is_always_open() || now.ns < next_try_ns_) return;
  const bool is_open = hours_.is_open(now.time);
  if (day_.lights == is_open) return;
  if (const auto done = lights_.turn(is_open); !done) {
    log::warning("the light cannot be turned {}: {}", is_open ? "on" : "off", done.error().what);
    next_try_ns_ = now.ns + kTryAgain_ns;
    return;
  }
  day_.lights = is_open;
  day_.note(now.time, is_open ? "open: the light is on" : "closed: the light is off");
  log::info("{}", day_.events.back().text);
  errands_.add(is_open ? settings_.opening : settings_.closing, "");
  save(Lasting::day);
}

void NightWatch::ask_supervisor(Moment now) {
  std::error_code unknown;
  if (const auto space = fs::space(folder_, unknown); !unknown) {
    day_.disk_free_gb = static_cast<double>(space.available) / kBytesPerGb;
    day_.disk_gb = static_cast<double>(space.capacity) / kBytesPerGb;
  }
  const auto answer =
      control::ask_with_descriptors(rig_.settings.name, {.verb = control::Verb::status}, kPatience);
  Wrongs wrongs;
  if (answer && answer->object.contains("status")) {
    const auto status = status_in(answer->object["status"]);
    for (const auto& [name, service] : status.services) track(daemon::marks_stream_of(name));
    tally_.add(status, now.time);
    const bool is_switched_off = !settings_.closing.empty() && day_.lights == false;
    wrongs = finder_.find(status, {day_.disk_free_gb, is_switched_off, now.ns});
  } else {
    wrongs = finder_.find_without_status(now.ns);
  }
  for (const auto& notice : book_.look(wrongs, now.ns, now.time)) tell(notice, now);
  if (gives_up_ != (book_.lasting_s(now.ns) >= kGivesUp_s)) give_up(now);
}

/// Asks whoever may to reboot the computer, or, if the fault is over, not to: the unit
/// handcast-reboot@RIG.path waits for this file.
void NightWatch::give_up(Moment now) {
  gives_up_ = !gives_up_;
  const auto request = folder_ / "gives-up";
  std::error_code absent;
  if (!gives_up_) {
    fs::remove(request, absent);
    return;
  }
  day_.note(now.time, "a fault lasts; a reboot may help");
  if (const auto written = write_whole(request, ""); !written)
    log::warning("{}", written.error().what);
}

/// Returns the name of the box; empty if there is none.
std::string NightWatch::keep_box(const FaultBook::Notice& notice, Moment now) {
  if (settings_.black_box.seconds <= 0) return {};
  auto name = date_of(now.time) + "_" + clock_of(now.time);
  std::ranges::replace(name, ':', '-');
  BoxContents contents{.fault = notice.text, .changes = {}, .streams = {}};
  for (const auto& change : changes_) contents.changes += change.text;
  for (const auto& [stream, track] : tracks_)
    if (auto kept = track->give(); kept->count() > 0)
      contents.streams.emplace_back(stream, std::move(kept));
  boxes_.write(name, std::move(contents));
  return name;
}

void NightWatch::tell(const FaultBook::Notice& notice, Moment now) {
  log::warning("{}", notice.text);
  std::string box;
  if (!notice.is_over) {
    box = keep_box(notice, now);
    if (auto* fault = day_.open_fault(notice.kind)) fault->black_box = box;
  }
  alert(notice.text + "\n" +
        (box.empty() ? "" : fmt::format("before it: {}\n", boxes_.place_of(box).string())));
  save(Lasting::day);
}

void NightWatch::alert(const std::string& text) {
  errands_.add(settings_.alert.command,
               fmt::format("handcast, rig '{}' on {}: {}the day: {}\n", rig_.settings.name,
                           host_name(), text, page_file(folder_, day_.date).string()));
}

void NightWatch::save(Lasting lasting) {
  const auto durable = lasting == Lasting::day ? Durable::yes : Durable::no;
  for (const auto& [file, text] : {std::pair(json_file(folder_, day_.date), to_json(day_)),
                                   std::pair(page_file(folder_, day_.date), report_page(day_))})
    if (const auto written = write_whole(file, text, durable); !written)
      log::warning("{}", written.error().what);
}

void NightWatch::stop(Moment now) {
  day_.note(now.time, "the night watch stopped");
  tally_.pass(now.ns, now.time, {lights_.is_dark(), book_.has_open()});
  save(Lasting::day);
}

}  // namespace handcast::watch
