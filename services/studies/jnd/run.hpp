// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/studies/jnd/course.hpp"
#include "services/studies/jnd/stimulus.hpp"

namespace handcast::study {

/// The arguments of `handcast study jnd`.
struct JndOptions {
  std::string folder = "jnd";  ///< of the logs
  CourseSettings course;
  StimulusSettings stimulus;
  std::vector<std::string> analysed;   ///< files and folders to be analysed
  bool simulates = false;              ///< subjects
  int subjects = 200;                  ///< simulated ones
  std::string json_file, page_folder;  ///< of an analysis or a simulation
  std::string picture_file;            ///< a picture of the stimulus
  std::string monitor;
  std::string midi;  ///< a device whose buttons answer
  bool in_window = false;
  double rate_hz = 60;
  double interval_s = 3;
  bool answers_by_model = false;
};

/// Text for --help, or the options. Errors: bad_config.
struct ParsedJnd {
  JndOptions options;
  std::string text;
};
Result<ParsedJnd> parse_jnd(int argc, char** argv);

/// `handcast study jnd`, with the arguments of a process. Returns the exit code.
int run_jnd(int argc, char** argv);

/// Takes a subject through the course, on the screen. Errors: those of StudyScreen and StudyLog.
/// Returns a sentence about what is done.
Result<std::string> take_course(const JndOptions& options);

/// The files of a subject in the folder of a study.
/// @{
std::string log_file(const JndOptions& options);
std::string light_file(const JndOptions& options);
std::string marks_file(const JndOptions& options, Condition condition);
/// @}

}  // namespace handcast::study
