// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "services/studies/pose/pose.hpp"
#include "services/studies/pose/sessions.hpp"

namespace handcast::study {
namespace {

using preview::Align;
using preview::Box;
using preview::Canvas;
using preview::Colour;

constexpr auto kText = Colour::of(0x1c232b), kFaint = Colour::of(0x6b7682),
               kScale = Colour::of(0xd8dde3), kRange = Colour::of(0x1273c4);
constexpr double kMargin = 42, kTextWidth = kPage_pt[0] - 2 * kMargin;
constexpr double kMostDegrees = 120;

glm::vec2 at(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

/// "2026-11-28T16:27:43Z" as people write it.
std::string readable(const std::string& time) {
  auto text = time.substr(0, std::size("2026-11-28T16:27") - 1);
  std::ranges::replace(text, 'T', ' ');
  return text;
}

/// Writes the sessions in two columns. Returns where it ends.
double list_sessions(Canvas& page, std::span<const PoseSession> sessions, std::size_t first_number,
                     double y) {
  constexpr double kLine = 13;
  const std::size_t lines = std::max<std::size_t>(1, (sessions.size() + 1) / 2);
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    const auto& session = sessions[s];
    const double x = kMargin + (s < lines ? 0 : 0.53 * kTextWidth),
                 line_y = y + kLine * static_cast<double>(s % lines);
    page.text(at(x + 16, line_y), fmt::format("{}", first_number + s), {9, true}, kText,
              Align::right);
    page.text(at(x + 26, line_y), readable(session.time), {9}, kText);
    page.text(at(x + 158, line_y),
              fmt::format("{} pose{}", session.poses.size(), session.poses.size() == 1 ? "" : "s"),
              {9}, kText, Align::right);
    page.text(at(x + 215, line_y), fmt::format("{:.1f} s", session.seconds()), {9}, kText,
              Align::right);
  }
  return y + kLine * static_cast<double>(lines);
}

/// A frame for degrees, upwards from stretched to bent.
double height_of(const Box& box, double degrees) {
  return box.bottom() - box.height * std::clamp(degrees, 0.0, kMostDegrees) / kMostDegrees;
}

void grid(Canvas& page, const Box& box) {
  for (const int degrees : {0, 60, 120}) {
    const double y = height_of(box, degrees);
    const preview::Line line{at(box.x, y), at(box.right(), y)};
    page.stroke({&line, 1}, kScale, 0.6);
    page.text(at(box.x - 4, y + 2.5), fmt::format("{}°", degrees), {7}, kFaint, Align::right);
  }
}

/// The range of a joint: a bar for each session, from its least to its most degrees.
void draw_joint(Canvas& page, const Box& box, const std::string& joint,
                std::span<const PoseSession> sessions, std::size_t first_number) {
  page.text(at(box.x - 18, box.y - 9), joint, {9.5, true}, kText);
  grid(page, box);
  const double step = box.width / std::max(6.0, static_cast<double>(sessions.size()));
  std::string newest;
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    const auto range = sessions[s].ranges.find(joint);
    if (range == sessions[s].ranges.end()) continue;
    const auto [least, most] = range->second;
    newest = fmt::format("{:.0f}° to {:.0f}°", least, most);
    const double top = height_of(box, most), x = box.x + step * (static_cast<double>(s) + 0.5);
    page.fill(Box{x - 0.3 * step, top, 0.6 * step, std::max(1.0, height_of(box, least) - top)},
              kRange, 1);
    if (sessions.size() <= 10 || s % 5 == 0)
      page.text(at(x, box.bottom() + 9), fmt::format("{}", first_number + s), {7}, kFaint,
                Align::centre);
  }
  page.text(at(box.right(), box.y - 9), newest.empty() ? "not seen" : newest, {8.5}, kFaint,
            Align::right);
}

void explain(Canvas& page, const Box& box) {
  double y = box.y + 6;
  for (const char* line :
       {"A bar is a session: from", "the most stretched (below)", "to the most bent (above),",
        "without the outermost 2 %.", "Numbers: the last session."}) {
    page.text(at(box.x - 18, y), line, {8.5}, kFaint);
    y += 12;
  }
}

}  // namespace

void draw_pose_page(Canvas& page, const std::string& person, std::span<const PoseSession> sessions,
                    std::size_t first_number) {
  page.text(at(kMargin, 58), fmt::format("Person {}", person), {20, true}, kText);
  page.text(at(kMargin + kTextWidth, 58), "Guess the Pose: times and range of motion", {10}, kFaint,
            Align::right);
  double y = list_sessions(page, sessions, first_number, 84) + 26;
  constexpr std::size_t kColumns = 3, kRows = 5;
  constexpr double kColumn = kTextWidth / kColumns;
  const double row = (kPage_pt[1] - kMargin - y) / static_cast<double>(kRows);
  const auto box_of = [&](std::size_t cell) {
    const std::size_t line = cell / kColumns, column = cell % kColumns;
    return Box{kMargin + 20 + kColumn * static_cast<double>(column),
               y + row * static_cast<double>(line), kColumn - 34, row - 40};
  };
  // Two joints of the thumb, then three of each finger: a row for each.
  for (std::size_t joint = 0; joint < kFlexions; ++joint)
    draw_joint(page, box_of(joint < 2 ? joint : joint + 1), flexion_name(joint), sessions,
               first_number);
  explain(page, box_of(2));
}

Result<std::string> pose_pdf(const std::vector<StudyTable>& logs) {
  preview::PaperCanvas paper(kPage_pt[0], kPage_pt[1], "handcast: Guess the Pose");
  for (const auto& log : logs) {
    const auto sessions = pose_sessions(log);
    if (!sessions) return tl::make_unexpected(sessions.error());
    for (std::size_t first = 0; first < sessions->size(); first += kSessionsOfAPage) {
      const auto count = std::min(kSessionsOfAPage, sessions->size() - first);
      draw_pose_page(paper, log.rows[0][0], std::span(*sessions).subspan(first, count), first + 1);
      paper.end_page();
    }
  }
  return paper.finish();
}

}  // namespace handcast::study
