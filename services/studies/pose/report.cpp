// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/text.hpp"
#include "services/studies/base/page.hpp"
#include "services/studies/pose/pose.hpp"
#include "services/studies/pose/run.hpp"
#include "services/studies/pose/sessions.hpp"

namespace handcast::study {
namespace {

/// The range of a joint over the sessions: a bar for each, from stretched to bent.
std::string bars_of(const std::vector<PoseSession>& sessions, const std::string& joint) {
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
          html_of(sessions[s].time), range->second[0], range->second[1]);
  return svg + "</svg>";
}

std::string ranges_of(const std::vector<PoseSession>& sessions) {
  std::string rows;
  for (std::size_t joint = 0; joint < kFlexions; ++joint) {
    const auto name = flexion_name(joint);
    const auto has = [&](const PoseSession& session) { return session.ranges.contains(name); };
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

Result<std::string> pose_report(const std::vector<StudyTable>& logs) {
  std::string page = page_head("Guess the Pose");
  for (const auto& log : logs) {
    const auto sessions = pose_sessions(log);
    if (!sessions) return tl::make_unexpected(sessions.error());
    if (sessions->empty()) continue;
    page += fmt::format("<h2>Person {}</h2><table><tr><th>Session<th>poses<th>seconds in all</tr>",
                        html_of(log.rows[0][0]));
    for (const auto& session : *sessions)
      page += fmt::format("<tr><td>{}<td>{}<td>{:.1f}", html_of(session.time), session.poses.size(),
                          session.seconds());
    page += "</table>" + ranges_of(*sessions);
  }
  return page + "</html>\n";
}

}  // namespace handcast::study
