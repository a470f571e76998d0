// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/studies/base/comparison.hpp"
#include "services/studies/jnd/course.hpp"

namespace handcast::study {

/// A test session of a subject, for the report.
struct SubjectSession {
  std::string subject;
  SessionResult result;
};

/// What was found in the files of a study.
struct JndFindings {
  Comparison comparison;                 ///< of the JNDs
  std::vector<SubjectSession> sessions;  ///< of logs: with the other estimates
  std::string way;                       ///< of logs: their protocol and stimulus
  std::vector<std::string> unfinished;   ///< logs whose course is not over, in sentences
};

/// Analyses files: logs of subjects, or tables with the columns subject, condition and jnd_ms; a
/// folder stands for the logs in it. Training sessions do not count. Errors: bad_config (a file
/// cannot be read, or there is none), bad_data.
Result<JndFindings> analyse(const std::vector<std::string>& files);

nlohmann::json to_json(const JndFindings& findings);
/// A page with the figure of the paper (JNDs by subject, places that were looked at), HTML.
/// `heat`: the name of a picture beside the page; empty: there is none.
std::string page_of(const JndFindings& findings, const std::string& heat);

}  // namespace handcast::study
