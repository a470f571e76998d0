// SPDX-License-Identifier: Apache-2.0
#include "tests/services/pose/openxr/runtime/script.hpp"

#include <sys/stat.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <tuple>

namespace handcast::test_runtime {
namespace {

const std::map<std::string, bool Script::*> kFlags{{"refuses", &Script::refuses},
                                                   {"crashes", &Script::crashes},
                                                   {"hangs_at_start", &Script::hangs_at_start},
                                                   {"hangs", &Script::hangs},
                                                   {"no_system", &Script::no_system},
                                                   {"no_hands", &Script::no_hands},
                                                   {"no_stage", &Script::no_stage},
                                                   {"never_ready", &Script::never_ready},
                                                   {"stops", &Script::stops},
                                                   {"loses_session", &Script::loses_session},
                                                   {"loses_instance", &Script::loses_instance},
                                                   {"ends", &Script::ends},
                                                   {"moves_space", &Script::moves_space},
                                                   {"unknown_joint", &Script::unknown_joint},
                                                   {"no_number", &Script::no_number},
                                                   {"refuses_times", &Script::refuses_times}};
const std::map<std::string, double Script::*> kNumbers{
    {"rate_hz", &Script::rate_hz}, {"age_ms", &Script::age_ms}, {"noise_mm", &Script::noise_mm}};
const std::map<std::string, Times> kTimes{{"interpolates", Times::interpolates},
                                          {"holds", Times::holds},
                                          {"predicts", Times::predicts},
                                          {"knows", Times::knows},
                                          {"overshoots", Times::overshoots}};

void take(const std::string& word, std::istringstream& rest, Script& script) {
  if (const auto flag = kFlags.find(word); flag != kFlags.end()) script.*flag->second = true;
  if (const auto number = kNumbers.find(word); number != kNumbers.end())
    rest >> script.*number->second;
  if (word == "epoch_ns") rest >> script.epoch_ns;
  if (word == "motion") rest >> script.motion;
  std::string value;
  if (word == "lacks" && rest >> value) script.lacks.insert(value);
  if (word == "inactive" && rest >> value) script.inactive.insert(value);
  if (word == "times" && rest >> value) script.times = kTimes.at(value);
}

Script read(const char* path) {
  Script script;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream rest(line);
    std::string word;
    if (rest >> word) take(word, rest, script);
  }
  return script;
}

}  // namespace

const Script& script() {
  static Script current;
  static std::tuple<ino_t, off_t, long, long> version;
  const char* path = std::getenv(kScriptVariable);
  struct stat file {};
  if (!path || ::stat(path, &file) != 0) return current = {};
  const std::tuple found{file.st_ino, file.st_size, file.st_mtim.tv_sec, file.st_mtim.tv_nsec};
  if (found != version) current = read(path);
  version = found;
  return current;
}

}  // namespace handcast::test_runtime
