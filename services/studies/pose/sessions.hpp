// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/studies/base/study_table.hpp"
#include "services/tools/preview/canvas/canvas.hpp"

namespace handcast::study {

/// A session of a person, as its log has it.
struct PoseSession {
  std::string time;                                     ///< when it began, UTC
  std::vector<std::pair<std::string, double>> poses;    ///< name, seconds
  std::map<std::string, std::array<double, 2>> ranges;  ///< by joint: least and most, degrees

  double seconds() const;  ///< of all poses
};

/// The sessions of a log, in order. Errors: bad_data (no log of this game).
Result<std::vector<PoseSession>> pose_sessions(const StudyTable& log);

/// A page has so many sessions at most, and this size, A4 in points.
inline constexpr std::size_t kSessionsOfAPage = 20;
inline constexpr double kPage_pt[2] = {595.28, 841.89};

/// Draws a page of the report: the sessions of a person, of which the first one has that number,
/// with their times and the range of motion of each joint.
void draw_pose_page(preview::Canvas& page, const std::string& person,
                    std::span<const PoseSession> sessions, std::size_t first_number);

/// The report as a PDF file: pages for each person. Errors: those of pose_sessions().
Result<std::string> pose_pdf(const std::vector<StudyTable>& logs);

}  // namespace handcast::study
