// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "services/lab/twin/random.hpp"
#include "services/studies/base/rig_hand.hpp"
#include "services/studies/base/study_command.hpp"
#include "services/studies/character/course.hpp"
#include "services/studies/character/picture.hpp"

namespace handcast::study {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kLogs = "character";
constexpr int kWidth_px = 1024, kHeight_px = 640;
constexpr char kNotes[] =
    R"(Start it beside a rig that is up. The palm shows a character, four finger tips show one each: bend the finger with the
character of the palm, as fast as you can. A session has 20 rounds; 24 sessions with and without the corrections of the
rig in turn, on the palm and on the back, after 4 for training. The log is DIR/character-NN.csv; a session that was left
with Ctrl-C, or by a crash, is begun again when the command is given again.

  handcast study character DIR --subject 1             a subject
  handcast study character --analyse DIR --page OUT    times, t-test and difficulty, as in the paper)";

struct Options {
  std::string folder = "character", rig, json_file, page_folder;
  std::vector<std::string> analysed;
  int subject = 1, tests = 24, rounds = 20, difficulty = 0;
  double seed = 1;
  msg::Side side = msg::Side::left;
};

Result<std::string> analyse_logs(const Options& options) {
  const auto logs = read_logs(options.analysed, kLogs);
  if (!logs) return tl::make_unexpected(logs.error());
  const auto findings = analyse_characters(*logs);
  if (!findings) return tl::make_unexpected(findings.error());
  const std::string text = describe(findings->seconds, "s") +
                           "By pair of sessions, as in the paper:\n" +
                           describe(findings->pairs, "s");
  if (auto written = write_json(options.json_file, to_json(*findings)); !written)
    return tl::make_unexpected(written.error());
  if (options.page_folder.empty()) return text;
  return write_page(options.page_folder, page_of(*findings)).map([&](const auto& file) {
    return text + file.string() + "\n";
  });
}

CharacterPlayer player_of(const Options& options) {
  return {.subject = options.subject,
          .seed = static_cast<std::uint64_t>(options.seed),
          .hand = options.side};
}

/// One subject at the rig.
class Play {
 public:
  Play(const Options& options, StudyLog log, RigHand hand, CharacterPicture picture)
      : options_(options),
        log_(std::move(log)),
        hand_(std::move(hand)),
        picture_(std::move(picture)) {}

  Result<std::string> run() {
    const auto sessions = character_sessions(options_.subject, options_.tests);
    const auto done = static_cast<std::size_t>(sessions_done(log_.earlier()));
    for (std::size_t s = done; s < sessions.size(); ++s)
      if (auto played = play(sessions[s], sessions.size()); !played)
        return tl::make_unexpected(played.error());
    return fmt::format("Subject {} has done all sessions.\n", options_.subject);
  }

 private:
  Result<void> play(const CharacterSession& session, std::size_t sessions) {
    fmt::print("Session {} of {}{}: show the {} of your hand to the light.\n", session.number + 1,
               sessions, session.is_training ? ", for training" : "",
               session.face == Face::palm ? "palm" : "back");
    std::fflush(stdout);
    if (auto set = hand_.set(settings_of(session.is_corrected)); !set) return set;
    const auto seed = twin::mixed(static_cast<std::uint64_t>(options_.seed) ^
                                  twin::mixed((1000 * static_cast<std::uint64_t>(options_.subject) +
                                               static_cast<std::uint64_t>(session.number)) ^
                                              twin::mixed(log_.earlier().rows.size())));
    CharacterGame game(seed, options_.rounds);
    while (!game.is_over()) {
      if (daemon::stop_requested()) return fail(Errc::disconnected, "the session was left");
      if (auto waited = hand_.wait(); !waited) return waited;
      const auto answered = game.results().size();
      game.step(ns_to_seconds(now_ns()), hand_.joints() ? &*hand_.joints() : nullptr);
      if (auto shown = hand_.show(picture_.draw(game.scene(), session.face)); !shown) return shown;
      if (game.results().size() == answered) continue;
      const auto& answer = game.results().back();
      if (auto kept = log_.add(line_of(player_of(options_), session,
                                       static_cast<int>(game.results().size()), answer));
          !kept)
        return kept;
      fmt::print("  {:2}  {:.2f} s  {}\n", game.results().size(), answer.seconds,
                 answer.is_correct() ? "right" : "wrong");
      std::fflush(stdout);
    }
    const auto difficulty = ask_difficulty();
    if (!difficulty) return tl::make_unexpected(difficulty.error());
    return log_.add(line_of(player_of(options_), session, *difficulty));
  }

  Result<int> ask_difficulty() const {
    if (options_.difficulty > 0) return options_.difficulty;
    for (;;) {
      fmt::print("How difficult was the task? 1 (easy) to 5 (hard): ");
      std::fflush(stdout);
      std::string line;
      if (!std::getline(std::cin, line))
        return fail(Errc::disconnected, "the question of difficulty was not answered");
      if (line.size() == 1 && line[0] >= '1' && line[0] <= '5') return line[0] - '0';
    }
  }

  Options options_;
  StudyLog log_;
  RigHand hand_;
  CharacterPicture picture_;
};

Result<std::string> run(const Options& options) {
  if (!options.analysed.empty()) return analyse_logs(options);
  auto log = StudyLog::open(fs::path(options.folder) / log_name(kLogs, options.subject),
                            character_columns());
  if (!log) return tl::make_unexpected(log.error());
  if (auto same = check_player(log->earlier(), player_of(options)); !same)
    return tl::make_unexpected(same.error());
  auto hand = RigHand::open(options.rig, options.side, kWidth_px, kHeight_px, "study character");
  if (!hand) return tl::make_unexpected(hand.error());
  const auto mesh = hand->mesh();
  if (!mesh) return tl::make_unexpected(mesh.error());
  CharacterPicture picture(*mesh, kWidth_px, kHeight_px);
  return Play(options, std::move(*log), std::move(*hand), std::move(picture)).run();
}

}  // namespace

int run_character(int argc, char** argv) {
  Options options;
  CommandLine line("handcast study character",
                   "Guess the Character: how fast people read and act on what is on their hand.",
                   kNotes);
  line.add("[DIR]", options.folder, "The folder of the study");
  line.add("--subject N", options.subject, "The subject, a number instead of a name",
           {1, kMostSubjects});
  line.add("--seed S", options.seed, "Seed of all random numbers", {0, 1e15});
  add_rig_hand(line, options.rig, options.side);
  line.add("--sessions N", options.tests, "Sessions after the training", {2, 200});
  line.add("--rounds N", options.rounds, "Rounds of a session", {1, 200});
  line.add("--difficulty D", options.difficulty,
           "Answers the question of difficulty at once, to try the program", {1, 5});
  line.add("--analyse FILE", options.analysed, "Analyses logs, or a folder of logs");
  line.add("--json FILE", options.json_file, "Writes the results");
  line.add("--page DIR", options.page_folder, "Writes the results as a page, DIR/index.html");
  if (const auto code = line.answered(argc, argv)) return *code;
  daemon::install_stop_signals();  // so that the rig shows again what it showed before
  return end_of("handcast study character", run(options));
}

}  // namespace handcast::study
