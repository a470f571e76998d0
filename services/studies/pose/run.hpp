// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/studies/base/study_table.hpp"

namespace handcast::study {

/// The log of a person: a line for each pose that was matched, and one for the range of each joint
/// at the end of a session.
CsvRow pose_columns();
/// The times of the sessions and the ranges of the joints over them, for people: a page, HTML.
/// Errors: bad_data (no log of this game).
Result<std::string> pose_report(const std::vector<StudyTable>& logs);

/// `handcast study pose`. Returns the exit code.
int run_pose(int argc, char** argv);

}  // namespace handcast::study
