// SPDX-License-Identifier: Apache-2.0
#include "services/studies/pose/sessions.hpp"

#include <fmt/format.h>

#include "services/studies/pose/run.hpp"

namespace handcast::study {
namespace {

enum LogColumn : std::size_t { kPerson, kSessionTime, kKind, kName, kFirst, kSecond };

}  // namespace

CsvRow pose_columns() { return {"person", "session", "kind", "name", "first", "second"}; }

double PoseSession::seconds() const {
  double sum = 0;
  for (const auto& [name, seconds] : poses) sum += seconds;
  return sum;
}

Result<std::vector<PoseSession>> pose_sessions(const StudyTable& log) {
  if (log.columns != pose_columns())
    return fail(Errc::bad_data, fmt::format("{}: the file is no log of poses", log.name));
  std::vector<PoseSession> sessions;
  for (std::size_t r = 0; r < log.rows.size(); ++r) {
    const auto& row = log.rows[r];
    if (sessions.empty() || sessions.back().time != row[kSessionTime])
      sessions.push_back({.time = row[kSessionTime], .poses = {}, .ranges = {}});
    const auto first = log.number(r, kFirst);
    if (!first) return tl::make_unexpected(first.error());
    if (row[kKind] == "pose") {
      sessions.back().poses.emplace_back(row[kName], *first);
      continue;
    }
    const auto second = log.number(r, kSecond);
    if (!second) return tl::make_unexpected(second.error());
    sessions.back().ranges[row[kName]] = {*first, *second};
  }
  return sessions;
}

}  // namespace handcast::study
