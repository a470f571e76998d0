// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <optional>
#include <sstream>

#include "ipc/base/clock.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/log.hpp"
#include "renderer/media/picture.hpp"
#include "services/lab/twin/random.hpp"
#include "services/studies/jnd/midi_buttons.hpp"
#include "services/studies/jnd/run.hpp"
#include "services/studies/jnd/show.hpp"
#include "services/studies/jnd/subjects.hpp"

namespace handcast::study {
namespace {

namespace fs = std::filesystem;

constexpr int kMostRepeats = 10;       ///< of an interval with missed refreshes
constexpr double kLongestStart_s = 8;  ///< an interval begins up to here in the motion
constexpr double kPause_s = 0.4;

/// Where in the motion both intervals of a trial begin.
double start_s(const CourseSettings& course, const Trial& trial) {
  const auto session =
      10 * static_cast<std::uint64_t>(course.subject) + static_cast<std::uint64_t>(trial.session);
  const auto key = 1000 * session + static_cast<std::uint64_t>(trial.number);
  const auto seed = course.seed;
  return kLongestStart_s * static_cast<double>(twin::mixed(seed ^ twin::mixed(key + 77)) >> 11) *
         0x1p-53;
}

constexpr const char* kConsentKeys = "Space: I agree to take part        Escape: I do not";

/// The page of consent: consent.txt of the folder, if there is one. Errors: bad_config (it cannot
/// be read, or would not fit on a screen).
Result<std::vector<std::string>> consent(const fs::path& folder) {
  const auto file = folder / "consent.txt";
  std::error_code unknown;
  if (!fs::exists(file, unknown))
    return std::vector<std::string>{
        "Late light on a moving hand",
        "You compare pairs of short films and say in which one the light is late.",
        "It takes about an hour; you may stop at any time by pressing Escape.",
        "What is kept: your answers, how long they took, and where you looked.",
        "Your name is not kept.",
        "",
        kConsentKeys};
  const auto own = read_input(file, kMostText);
  if (!own) return tl::make_unexpected(own.error());
  constexpr std::size_t kMostLines = 14, kLongest = 90;
  std::vector<std::string> lines;
  std::istringstream text(*own);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  const auto is_long = [](const auto& line) { return line.size() > kLongest; };
  if (lines.empty() || lines.size() > kMostLines || std::ranges::any_of(lines, is_long))
    return fail(Errc::bad_config,
                fmt::format("{}: it must have 1 to {} lines of at most {} letters, to fit on the "
                            "screen",
                            file.string(), kMostLines, kLongest));
  lines.insert(lines.end(), {"", kConsentKeys});
  return lines;
}

/// One subject at the screen.
class Sitting {
 public:
  Sitting(const JndOptions& options, Course course, StudyLog log, StudyLog light, Stimulus stimulus,
          std::unique_ptr<StudyScreen> screen, std::optional<MidiButtons> buttons)
      : options_(options),
        course_(std::move(course)),
        log_(std::move(log)),
        light_(std::move(light)),
        stimulus_(std::move(stimulus)),
        screen_(std::move(screen)),
        buttons_(std::move(buttons)) {
    if (options.answers_by_model)
      model_.emplace(predicted_jnds_ms(stimulus_.speeds_deg_s(0, kLongestStart_s)),
                     options.course.seed, options.course.subject);
  }

  Result<std::string> run() {
    if (const auto agreed = agree(); !agreed || !*agreed)
      return agreed.map([](bool) { return std::string("The subject did not agree."); });
    if (const auto learned = learn_buttons(); !learned || !*learned)
      return learned.map([&](bool) { return left(); });
    // A program that was ended at the painting asks for it now.
    for (const auto& result : course_.results())
      if (!result.is_training && !fs::exists(marks_file(options_, result.condition)))
        if (auto marked = mark(result.condition); !marked)
          return tl::make_unexpected(marked.error());
    while (const auto trial = course_.trial()) {
      if (course_.begins_session()) {
        const auto begun = begin(*trial);
        if (!begun || !*begun) return begun.map([&](bool) { return left(); });
      }
      const auto answer = ask(*trial);
      if (!answer) return tl::make_unexpected(answer.error());
      if (!*answer) return left();
      const auto now = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
      if (auto added = log_.add(course_.line(**answer, now)); !added)
        return tl::make_unexpected(added.error());
      course_.answer(**answer);
      if (course_.begins_session() && !trial->is_training)
        if (auto marked = mark(trial->condition); !marked)
          return tl::make_unexpected(marked.error());
    }
    if (!model_)
      if (auto thanked = screen_->tell({"Thank you", "All sessions are done."}, 2); !thanked)
        return tl::make_unexpected(thanked.error());
    return fmt::format("Subject {} has done all sessions; {}", options_.course.subject,
                       log_file(options_));
  }

 private:
  std::string left() const {
    return fmt::format("Left after {} sessions; the same command goes on from there.",
                       course_.results().size());
  }

  /// The page of consent, once.
  Result<bool> agree() {
    if (model_ || !log_.earlier().rows.empty()) return true;
    const auto page = consent(options_.folder);
    if (!page) return tl::make_unexpected(page.error());
    return screen_->ask(*page, {kGoOn, kEscape}).map([](const auto& key) { return key == kGoOn; });
  }

  /// Finds out which buttons of a MIDI device are the two answers.
  Result<bool> learn_buttons() {
    if (!buttons_ || model_) return true;
    for (const std::string answer : {"1", "2"}) {
      const auto pressed = [&] {
        return std::vector<std::string>(buttons_->learn(answer) ? 1 : 0, answer);
      };
      const auto key = screen_->ask({"Buttons",
                                     fmt::format("Press the button that will say: the {} film.",
                                                 answer == "1" ? "first" : "second"),
                                     "", "Escape: later"},
                                    {answer, kEscape}, pressed);
      if (!key) return tl::make_unexpected(key.error());
      if (*key == kEscape) return false;
      log::info("a button of the MIDI device answers {}", answer);
    }
    return true;
  }

  /// The keys of the MIDI device.
  std::vector<std::string> buttons() {
    return buttons_ ? buttons_->take_keys() : std::vector<std::string>();
  }

  Result<bool> begin(const Trial& trial) {
    if (model_) return true;
    return screen_
        ->ask({fmt::format("Session {} of 4{}", trial.session + 1,
                           trial.is_training ? ", for training" : ""),
               "You will see pairs of films of a moving hand with light on it.",
               "In one of them the light is late. Press 1 if it was the first, 2 if the second.",
               "Guess if you do not know.", "", "Space: begin        Escape: later"},
              {kGoOn, kEscape})
        .map([](const auto& key) { return key == kGoOn; });
  }

  /// Shows both intervals and takes the answer; empty if the subject leaves.
  Result<std::optional<Answer>> ask(const Trial& trial) {
    Answer shown;
    for (const int interval : {1, 2}) {
      if (!model_)
        if (auto told = screen_->tell({fmt::format("{}", interval)}, kPause_s); !told || !*told)
          return told.map([](bool) { return std::optional<Answer>(); });
      if (auto played = play(trial, interval, shown); !played || !*played)
        return played.map([](bool) { return std::optional<Answer>(); });
    }
    if (model_) {
      auto answer = model_->answer(trial);
      answer.repeats = shown.repeats;
      answer.worst_error_ms = shown.worst_error_ms;
      return answer;
    }
    const auto begin_ns = now_ns();
    const auto key = screen_->ask({"In which film was the light late?", "1   or   2"},
                                  {"1", "2", kEscape}, [&] { return buttons(); });
    if (!key) return tl::make_unexpected(key.error());
    if (*key == kEscape) return std::optional<Answer>();
    shown.picks_first = *key == "1";
    shown.reaction_ms = ns_to_ms(now_ns() - begin_ns);
    return shown;
  }

  /// Shows an interval until no refresh was missed. Returns false if the subject leaves.
  Result<bool> play(const Trial& trial, int interval, Answer& shown) {
    const bool is_late = (interval == 1) == trial.is_late_first;
    for (int repeat = 0; repeat < kMostRepeats; ++repeat) {
      // Perfect light has no gaps: filled or not, it is the same.
      const auto played =
          screen_->play(stimulus_, start_s(options_.course, trial), options_.interval_s,
                        is_late ? trial.delay_ms : 0, trial.condition);
      if (!played) return tl::make_unexpected(played.error());
      if (played->is_left) return false;
      if (auto kept = keep(trial, interval, repeat, *played); !kept)
        return tl::make_unexpected(kept.error());
      shown.worst_error_ms = std::max(shown.worst_error_ms, played->worst_error_ms);
      if (played->missed == 0) return true;
      ++shown.repeats;
    }
    return fail(
        Errc::unavailable,
        fmt::format("an interval missed refreshes {} times in a row: this computer does not "
                    "draw {}x{} pixels every {:.1f} ms; choose a smaller --size, or stop what "
                    "else runs",
                    kMostRepeats, options_.stimulus.width_px, options_.stimulus.height_px,
                    screen_->period_ms()));
  }

  /// Writes when the pictures of an interval were shown.
  Result<void> keep(const Trial& trial, int interval, int repeat, const ShownInterval& played) {
    std::vector<CsvRow> rows;
    for (const auto& frame : played.frames)
      rows.push_back({fmt::format("{}", trial.session + 1), fmt::format("{}", trial.number + 1),
                      fmt::format("{}", interval), fmt::format("{}", repeat),
                      fmt::format("{:.6f}", frame.hand_s), fmt::format("{:.6f}", frame.light_s),
                      fmt::format("{}", frame.shown_ns), fmt::format("{:.3f}", frame.error_ms)});
    return light_.add(rows);
  }

  Result<void> mark(Condition condition) {
    if (model_) return {};
    const auto picture = stimulus_.draw(0, 0, Condition::baseline);
    const auto marks = screen_->paint(
        picture, "Paint where you looked to decide, with the mouse.        Space: done");
    if (!marks) return tl::make_unexpected(marks.error());
    return renderer::write_png(marks_file(options_, condition), marks->view());
  }

  JndOptions options_;
  Course course_;
  StudyLog log_, light_;
  Stimulus stimulus_;
  std::unique_ptr<StudyScreen> screen_;
  std::optional<MidiButtons> buttons_;
  std::optional<SimulatedSubject> model_;
};

}  // namespace

Result<std::string> take_course(const JndOptions& options) {
  auto log = StudyLog::open(log_file(options), Course::columns());
  if (!log) return tl::make_unexpected(log.error());
  auto light = StudyLog::open(
      light_file(options),
      {"session", "trial", "interval", "repeat", "hand_s", "light_s", "shown_ns", "error_ms"},
      StudyLog::Keeps::none);
  if (!light) return tl::make_unexpected(light.error());
  auto course_settings = options.course;
  const auto& shown = options.stimulus;
  course_settings.stimulus =
      fmt::format("{} x{} {} {}x{} {}/mm {}s", shown.motion, shown.speed, shown.content,
                  shown.width_px, shown.height_px, shown.px_per_mm, options.interval_s);
  Course course(course_settings);
  if (auto replayed = course.replay(log->earlier()); !replayed)
    return tl::make_unexpected(replayed.error());
  auto stimulus = Stimulus::open(options.stimulus);
  if (!stimulus) return tl::make_unexpected(stimulus.error());
  std::optional<MidiButtons> buttons;
  if (!options.midi.empty()) {
    auto opened = MidiButtons::open(options.midi);
    if (!opened) return fail(opened.error().code, "--midi: " + opened.error().what);
    buttons.emplace(std::move(*opened));
  }
  auto screen = StudyScreen::open({.title = "handcast study",
                                   .width_px = options.stimulus.width_px,
                                   .height_px = options.stimulus.height_px,
                                   .full_screen = !options.in_window,
                                   .monitor = options.monitor,
                                   .keeps_awake = true,
                                   .vsync = true,
                                   .when_display_is_lost = {}},
                                  options.rate_hz);
  if (!screen) return tl::make_unexpected(screen.error());
  return Sitting(options, std::move(course), std::move(*log), std::move(*light),
                 std::move(*stimulus), std::move(*screen), std::move(buttons))
      .run();
}

}  // namespace handcast::study
