// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/start_check.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <sstream>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::doctor {
namespace {

struct Answer {
  int exit_code = 0;
  std::string complaints;
};

/// Starts a program, whose errors go to `out`. -1 if it cannot be started.
pid_t start(std::vector<std::string> words, int out) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, out, STDERR_FILENO);
  pid_t child = -1;
  const int failed =
      posix_spawn(&child, arguments.front(), &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return failed ? -1 : child;
}

std::string read_to_end(int fd) {
  std::string text;
  std::array<char, 4096> bytes;
  for (ssize_t count = 0; (count = ::read(fd, bytes.data(), bytes.size())) != 0;) {
    if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) break;
  }
  return text;
}

std::optional<Answer> ask(std::vector<std::string> words) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  const UniqueFd from(ends[0]);
  UniqueFd to(ends[1]);
  const auto child = start(std::move(words), to.get());
  to = UniqueFd();
  if (child < 0) return std::nullopt;
  Answer answer{0, read_to_end(from.get())};
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  answer.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : kExitBadResult;
  return answer;
}

}  // namespace

std::vector<Finding> judge_check(int exit_code, const std::string& complaints) {
  if (exit_code == kExitDone)
    return {{"start", Grade::good, "`handcast up` accepts the rig's settings and files", ""}};
  std::vector<Finding> findings;
  std::istringstream lines(complaints);
  std::string line;
  std::getline(lines, line);  // "handcast: FILE:"
  while (std::getline(lines, line))
    if (line.starts_with("    ") && !findings.empty())  // a line of the file, and its caret
      findings.back().sentence += '\n' + line;
    else
      findings.push_back(
          {"start", Grade::fault, line, "`handcast up` refuses it; correct the file"});
  if (findings.empty())
    findings.push_back({"start", Grade::fault, complaints, "`handcast config --check`"});
  return findings;
}

std::vector<Finding> examine_start(const std::string& file,
                                   const std::vector<std::string>& settings) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  std::vector<std::string> words{self.parent_path() / "handcast", "config", "--check", file};
  for (const auto& setting : settings) words.insert(words.end(), {"--set", setting});
  if (const auto answer = ask(std::move(words)))
    return judge_check(answer->exit_code, answer->complaints);
  return {{"start", Grade::advice, "`handcast config --check` cannot be run",
           "is `handcast` in the folder of its other programs?"}};
}

}  // namespace handcast::doctor
