// SPDX-License-Identifier: Apache-2.0
// A newcomer's session of `handcast calibrate` on the twin, which holds boards and hands: in a
// terminal of its own, in which Enter is pressed some seconds after each instruction. Counts
// commands and keys, and the time to a rig without faults.
//   bench_calib_session [--reading S] [--goals FILE]
#include <fmt/format.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/program.hpp"
#include "tests/bench/goals.hpp"
#include "tests/scratch.hpp"

namespace handcast::bench {
namespace {

namespace fs = std::filesystem;

/// What the person has done.
struct Session {
  int commands = 0, keys = 0;
  std::string said;  ///< by the last command
  int exit_code = 0;
  int actions() const { return commands + keys; }
};

/// Runs a command in a terminal and presses Enter `reading_s` after each prompt.
void run(const std::vector<std::string>& words, double reading_s, Session& session) {
  constexpr std::string_view kPrompt = "s leaves it out";
  ++session.commands;
  session.said.clear();
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (const auto& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
    pointers.push_back(nullptr);
    execv(pointers.front(), pointers.data());
    _exit(127);
  }
  std::size_t answered = 0;
  std::int64_t press_ns = 0;
  for (std::array<char, 4096> bytes{};;) {
    if (press_ns != 0 && now_ns() >= press_ns) {
      press_ns = 0;
      ++session.keys;
      if (write(terminal, "\n", 1) != 1) break;
    }
    pollfd input{terminal, POLLIN, 0};
    if (poll(&input, 1, 100) == 0) continue;
    const auto count = read(terminal, bytes.data(), bytes.size());
    if (count <= 0) break;
    session.said.append(bytes.data(), static_cast<std::size_t>(count));
    fmt::print(stderr, "{}", std::string_view(bytes.data(), static_cast<std::size_t>(count)));
    if (const auto at = session.said.find(kPrompt, answered); at != std::string::npos) {
      answered = at + kPrompt.size();
      press_ns = now_ns() + seconds_to_ns(reading_s);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  close(terminal);
  session.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

std::vector<Goal> measure(double reading_s) {
  const test::Scratch scratch;
  setenv("HANDCAST_SCOPE", scratch.path().c_str(), 1);
  const auto folder = program_folder();
  const std::string handcast = folder / "handcast", rig = scratch.path() / "twin.toml";
  // 30 images per second: a small computer draws all of them while it measures.
  // The truth stays what it is when the rig gets the calibration that was measured.
  std::ofstream(scratch.path() / "truth.toml") << calib::print_calibration(calib::reference_rig());
  std::ofstream(rig) << "name = \"twin\"\n[camera]\nrate_hz = 30\n[observer]\nenabled = false\n"
                        "[twin.geometry]\ncalibration = \"truth.toml\"\n";
  Session session;
  std::vector<Goal> goals;
  const auto begin_ns = now_ns();
  run({handcast, "calibrate", "--print-board", scratch.path() / "board.pdf"}, reading_s, session);
  run({handcast, "calibrate", rig, "--apply"}, reading_s, session);
  const int calibrated = session.exit_code;
  run({handcast, "doctor", rig}, reading_s, session);
  const double minutes = ns_to_seconds(now_ns() - begin_ns) / 60;
  fmt::print("{} commands, {} keys; exit codes: calibrate {}, doctor {}\n", session.commands,
             session.keys, calibrated, session.exit_code);
  goals.push_back({"a newcomer's session on the twin", minutes, 10, "minutes"});
  goals.push_back({"actions of it", static_cast<double>(session.actions()), 25, ""});
  goals.push_back(
      {"faults of it (exit codes)", static_cast<double>(calibrated + session.exit_code), 0, ""});
  const auto check_ns = now_ns();
  run({handcast, "calibrate", rig, "--check"}, 0, session);
  goals.push_back({"--check of the rig after it", ns_to_seconds(now_ns() - check_ns), 30, "s"});
  goals.push_back({"its verdict (exit code)", static_cast<double>(session.exit_code), 0, ""});
  return goals;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  double reading_s = 5;
  const char* goals_file = nullptr;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--reading") == 0) reading_s = std::atof(argv[i + 1]);
    if (std::strcmp(argv[i], "--goals") == 0) goals_file = argv[i + 1];
  }
  const auto goals = measure(reading_s);
  print_goals(goals);
  if (!goals_file || write_goals(goals_file, goals)) return 0;
  fmt::print(stderr, "bench_calib_session: cannot write '{}'.\n", goals_file);
  return 1;
}
