// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "services/studies/jnd/options.hpp"

namespace handcast::study {

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
