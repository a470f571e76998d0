// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "services/studies/base/page.hpp"
#include "services/studies/pose/pose.hpp"
#include "services/studies/pose/run.hpp"

namespace handcast::study {
namespace {

enum LogColumn : std::size_t { kPerson, kSessionTime, kKind, kName, kFirst, kSecond };

struct Session {
  std::string time;
  std::vector<std::pair<std::string, double>> poses;    ///< name, seconds
  std::map<std::string, std::array<double, 2>> ranges;  ///< by joint: least and most, degrees
};

Result<std::vector<Session>> sessions_in(const StudyTable& log) {
  if (log.columns != pose_columns())
    return fail(Errc::bad_data, fmt::format("{}: the file is no log of poses", log.name));
  std::vector<Session> sessions;
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

/// The range of a joint over the sessions: a bar for each, from stretched to bent.
std::string bars_of(const std::vector<Session>& sessions, const std::string& joint) {
  constexpr double kWidth = 480, kPerDegree = kWidth / 130, kBar = 8;
  std::string svg = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"range\">",
                                kWidth, kBar * static_cast<double>(sessions.size()));
  for (std::size_t s = 0; s < sessions.size(); ++s)
    if (const auto range = sessions[s].ranges.find(joint); range != sessions[s].ranges.end())
      svg += fmt::format(
          "<rect class=\"bar1\" x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\"><title>{}: "
          "{:.0f}° "
          "to {:.0f}°</title></rect>",
          range->second[0] * kPerDegree, kBar * static_cast<double>(s),
          std::max(1.0, (range->second[1] - range->second[0]) * kPerDegree), kBar - 2,
          escaped(sessions[s].time), range->second[0], range->second[1]);
  return svg + "</svg>";
}

std::string ranges_of(const std::vector<Session>& sessions) {
  std::string rows;
  for (std::size_t joint = 0; joint < kFlexions; ++joint) {
    const auto name = flexion_name(joint);
    const auto has = [&](const Session& session) { return session.ranges.contains(name); };
    if (std::ranges::none_of(sessions, has)) continue;
    const auto first = std::ranges::find_if(sessions, has)->ranges.at(name);
    const auto last = std::find_if(sessions.rbegin(), sessions.rend(), has)->ranges.at(name);
    rows += fmt::format("<tr><td>{}<td>{:.0f}°…{:.0f}°<td>{:.0f}°…{:.0f}°<td>{:+.0f}°<td>{}", name,
                        first[0], first[1], last[0], last[1],
                        (last[1] - last[0]) - (first[1] - first[0]), bars_of(sessions, name));
  }
  return "<h2>Range of motion</h2><table class=\"wide\"><tr><th>Joint<th>first session<th>last "
         "session<th>range<th>sessions, from above</tr>" +
         rows + "</table>";
}

}  // namespace

CsvRow pose_columns() { return {"person", "session", "kind", "name", "first", "second"}; }

Result<std::string> pose_report(const std::vector<StudyTable>& logs) {
  std::string page = page_head("Guess the Pose");
  for (const auto& log : logs) {
    const auto sessions = sessions_in(log);
    if (!sessions) return tl::make_unexpected(sessions.error());
    if (sessions->empty()) continue;
    page += fmt::format("<h2>Person {}</h2><table><tr><th>Session<th>poses<th>seconds in all</tr>",
                        escaped(log.rows[0][kPerson]));
    for (const auto& session : *sessions) {
      double all_s = 0;
      for (const auto& [name, seconds] : session.poses) all_s += seconds;
      page += fmt::format("<tr><td>{}<td>{}<td>{:.1f}", escaped(session.time), session.poses.size(),
                          all_s);
    }
    page += "</table>" + ranges_of(*sessions);
  }
  return page + "</html>\n";
}

}  // namespace handcast::study
