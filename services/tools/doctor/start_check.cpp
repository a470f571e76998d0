// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/start_check.hpp"

#include <unistd.h>

#include <sstream>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "services/tools/devices/ask.hpp"

namespace handcast::doctor {
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
  std::vector<std::string> words{program_folder() / "handcast", "config", "--check", file};
  for (const auto& setting : settings) words.insert(words.end(), {"--set", setting});
  if (const auto answer = devices::ask(std::move(words), STDERR_FILENO))
    return judge_check(answer->exit_code, answer->text);
  return {{"start", Grade::advice, "`handcast config --check` cannot be run",
           "is `handcast` in the folder of its other programs?"}};
}

}  // namespace handcast::doctor
