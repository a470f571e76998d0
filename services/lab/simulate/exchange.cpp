// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <string>
#include <string_view>

#include "ipc/base/input_file.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/msg/check_guest.hpp"
#include "services/joints/conventions.hpp"
#include "services/recording/arrays/npy.hpp"

namespace handcast::simulate {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHead = 4;  ///< columns before those of the joints or landmarks

/// What a row has after its times and side: how certain the hand is, then `parts` of each place.
struct Layout {
  std::string_view certainty;
  std::size_t places;
  std::span<const std::string_view> parts;

  std::size_t columns() const { return kHead + places * parts.size(); }
  /// The columns of a place.
  std::span<const double> place(std::span<const double> row, std::size_t number) const {
    return row.subspan(kHead + number * parts.size(), parts.size());
  }
};

constexpr std::array<std::string_view, 8> kJointParts{"x",  "y",  "z",  "qx",
                                                      "qy", "qz", "qw", "radius"};
constexpr std::array<std::string_view, 4> kPointParts{"x", "y", "confidence", "sigma"};
constexpr Layout kPoses{"confidence", msg::kJoints, kJointParts};
constexpr Layout kLandmarks{"presence", msg::kLandmarks, kPointParts};

using Row = std::span<const double>;

struct Table {
  std::size_t columns = 0;
  std::vector<double> values;

  std::size_t rows() const { return values.size() / columns; }
  Row row(std::size_t number) const { return Row(values).subspan(number * columns, columns); }
};

Result<void> add_line(std::string_view line, std::size_t number, Table& table) {
  const auto before = table.values.size();
  for (const char *at = line.data(), *const end = at + line.size(); at < end; ++at) {
    while (at < end && *at == ' ') ++at;
    double value = 0;
    const auto read = std::from_chars(at, end, value);
    at = read.ptr;
    if (read.ec != std::errc() || (at < end && *at != ','))
      return fail(Errc::bad_data, fmt::format("line {}: a cell is not a number", number));
    table.values.push_back(value);
  }
  if (table.values.size() - before == table.columns) return {};
  return fail(Errc::bad_config, fmt::format("line {} has {} columns; it must have {}", number,
                                            table.values.size() - before, table.columns));
}

/// The first line names the columns; those of a table without it would lose a hand.
Result<Table> read_csv(const fs::path& file, std::size_t columns) {
  const auto text = read_input(file, kMostResults);
  if (!text) return tl::make_unexpected(text.error());
  if (!text->starts_with("origin_ns,"))
    return fail(Errc::bad_config,
                file.string() + ": the first line does not name the columns: origin_ns, …");
  Table table{columns, {}};
  std::size_t number = 0;
  for (std::string_view rest(*text); !rest.empty();) {
    const auto end = std::min(rest.find('\n'), rest.size());
    auto line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (++number == 1 || line.empty()) continue;
    if (auto added = add_line(line, number, table); !added)
      return fail_in(file.string(), added.error());
  }
  return table;
}

Result<Table> read_table(const fs::path& file, std::size_t columns) {
  if (file.extension() != ".npy") return read_csv(file, columns);
  auto array = recording::NpyFile::open(file);
  if (!array) return tl::make_unexpected(array.error());
  if (array->shape().size() != 2 || array->shape()[1] != columns)
    return fail(Errc::bad_config, fmt::format("{}: the array must have the shape (rows, {})",
                                              file.string(), columns));
  auto numbers = array->read();
  if (!numbers) return tl::make_unexpected(numbers.error());
  return Table{columns, std::move(numbers->values)};
}

msg::HandPose pose_of(Row row) {
  msg::HandPose pose;
  pose.side = static_cast<msg::Side>(row[2]);
  pose.confidence = static_cast<float>(row[3]);
  for (std::size_t i = 0; i < pose.joints.size(); ++i) {
    const auto cells = kPoses.place(row, i);
    const auto cell = [&](std::size_t k) { return static_cast<float>(cells[k]); };
    pose.joints[i] = {{cell(0), cell(1), cell(2)}, {cell(3), cell(4), cell(5), cell(6)}, cell(7)};
  }
  return pose;
}

/// The points without the distortion of the lens.
msg::HandLandmarks landmarks_of(Row row, const calib::CameraModel& lens) {
  msg::HandLandmarks hand;
  hand.side = static_cast<msg::Side>(row[2]);
  hand.presence = static_cast<float>(row[3]);
  for (std::size_t i = 0; i < hand.points.size(); ++i) {
    const auto cells = kLandmarks.place(row, i);
    const auto straight = lens.undistort({cells[0], cells[1]});
    hand.points[i] = {static_cast<float>(straight.x), static_cast<float>(straight.y),
                      static_cast<float>(cells[2]), static_cast<float>(cells[3])};
  }
  return hand;
}

Result<void> check_head(Row row) {
  constexpr double kLongest_ns = 1e15;
  for (std::size_t i = 0; i < 2; ++i)
    if (!(std::abs(row[i]) <= kLongest_ns))
      return fail(Errc::bad_data, "a time is not a number of ns since the begin of the run");
  if (row[1] + static_cast<double>(msg::kGuestAhead_ns) < row[0])
    return fail(Errc::bad_data, "it arrives more than 50 ms before it was seen");
  if (row[2] != -1 && row[2] != 0 && row[2] != 1)
    return fail(Errc::bad_data, "the side is not 0 (left), 1 (right) or -1 (no hand)");
  return {};
}

/// Message has `count` and `hands`; `hand_of` makes a hand from a row.
template <class Message, class HandOf>
Result<std::vector<SensorEvent>> messages_of(const Table& table, const HandOf& hand_of) {
  std::vector<std::pair<std::int64_t, Message>> made;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto row = table.row(i);
    const auto here = fmt::format("row {}", i + 1);
    if (auto head = check_head(row); !head) return fail_in(here, head.error());
    const auto origin_ns = static_cast<std::int64_t>(row[0]);
    const auto arrival_ns = static_cast<std::int64_t>(row[1]);
    const bool is_new = made.empty() || made.back().first != arrival_ns ||
                        made.back().second.header.origin_ns != origin_ns;
    if (is_new) made.emplace_back(arrival_ns, Message{});
    auto& message = made.back().second;
    message.header = {made.size(), origin_ns, 0};
    if (row[2] < 0) continue;
    if (message.count == message.hands.size())
      return fail(Errc::bad_data, here + ": a third hand with the same times");
    message.hands[message.count++] = hand_of(row);
    if (auto fits = msg::check_guest(message); !fits) return fail_in(here, fits.error());
  }
  std::vector<SensorEvent> events;
  events.reserve(made.size());
  for (const auto& [arrival_ns, message] : made) events.push_back({arrival_ns, message});
  std::ranges::stable_sort(events, {}, &SensorEvent::arrival_ns);
  return events;
}

/// Reads a file whose rows `hand_of` makes hands from.
template <class Message, class HandOf>
Result<std::vector<SensorEvent>> read(const fs::path& file, const Layout& layout,
                                      const HandOf& hand_of) {
  const auto table = read_table(file, layout.columns());
  if (!table) return tl::make_unexpected(table.error());
  if (table->rows() == 0)
    return fail(
        Errc::bad_config,
        file.string() + ": it has no rows; where no hand was found, write a row of side -1");
  auto events = messages_of<Message>(*table, hand_of);
  return events ? std::move(events) : fail_in(file.string(), events.error());
}

std::string names_of(const Layout& layout) {
  std::string line = fmt::format("origin_ns,arrival_ns,side,{}", layout.certainty);
  for (std::size_t i = 0; i < layout.places; ++i)
    for (const auto part : layout.parts) line += fmt::format(",{}_{}", part, i);
  return line + '\n';
}

std::string head_of(std::int64_t origin_ns, std::int64_t arrival_ns) {
  return fmt::format("{},{},", origin_ns, arrival_ns);
}

std::string line_of(const msg::HandPose& pose) {
  std::string line = fmt::format("{},{}", static_cast<int>(pose.side), pose.confidence);
  for (const auto& joint : pose.joints)
    line += fmt::format(",{},{},{}", fmt::join(joint.position_m, ","),
                        fmt::join(joint.orientation_xyzw, ","), joint.radius_m);
  return line + '\n';
}

std::string line_of(const msg::HandLandmarks& hand, const calib::CameraModel& lens) {
  std::string line = fmt::format("{},{}", static_cast<int>(hand.side), hand.presence);
  for (const auto& point : hand.points) {
    const auto seen = lens.distort({point.x_px, point.y_px});
    line += fmt::format(",{},{},{},{}", seen.x, seen.y, point.confidence, point.sigma_px);
  }
  return line + '\n';
}

/// Adds a row for each hand, of which `line` makes the columns behind the times.
template <class Message, class Line>
void add(const Message& message, const std::string& head, const Layout& layout, const Line& line,
         std::string& text) {
  if (message.count == 0) {
    text += head + "-1";
    for (std::size_t i = 3; i < layout.columns(); ++i) text += ",0";
    text += '\n';
  }
  for (const auto& hand : std::span(message.hands).first(message.count)) text += head + line(hand);
}

void add(const msg::HandPoses& poses, const std::string& head, std::string& text) {
  add(
      poses, head, kPoses, [](const auto& hand) { return line_of(hand); }, text);
}

void add(const msg::Landmarks& found, const std::string& head, const calib::CameraModel& lens,
         std::string& text) {
  add(
      found, head, kLandmarks, [&](const auto& hand) { return line_of(hand, lens); }, text);
}

/// A message of the true hands: `seen_of` gives what is seen of a side, which `take` puts into a
/// hand.
template <class Message, class SeenOf, class Take>
Message true_message(const SeenOf& seen_of, const Take& take) {
  Message message;
  for (const auto side : {msg::Side::left, msg::Side::right})
    if (const auto seen = seen_of(side)) {
      auto& hand = message.hands[message.count++];
      hand.side = side;
      take(*seen, hand);
    }
  return message;
}

/// The true hands as a tracker without errors would report them.
msg::HandPoses true_poses(const twin::Twin& twin, std::int64_t time_ns) {
  return true_message<msg::HandPoses>([&](msg::Side side) { return twin.joints(side, time_ns); },
                                      [](const auto& frames, msg::HandPose& pose) {
                                        pose.confidence = 1;
                                        for (std::size_t i = 0; i < pose.joints.size(); ++i) {
                                          const auto& frame = frames[i];
                                          const auto axes =
                                              glm::normalize(glm::quat_cast(glm::mat3(frame)));
                                          pose.joints[i] = {{frame[3].x, frame[3].y, frame[3].z},
                                                            {axes.x, axes.y, axes.z, axes.w},
                                                            joints::kMeanRadii_m[i]};
                                        }
                                      });
}

msg::Landmarks true_landmarks(const twin::Twin& twin, std::int64_t time_ns) {
  return true_message<msg::Landmarks>([&](msg::Side side) { return twin.landmarks(side, time_ns); },
                                      [](const auto& places_px, msg::HandLandmarks& hand) {
                                        hand.presence = 1;
                                        for (std::size_t i = 0; i < hand.points.size(); ++i)
                                          hand.points[i] = {places_px[i].x, places_px[i].y, 1, 0};
                                      });
}

}  // namespace

Result<std::vector<SensorEvent>> read_poses(const fs::path& file) {
  return read<msg::HandPoses>(file, kPoses, pose_of);
}

Result<std::vector<SensorEvent>> read_landmarks(const fs::path& file,
                                                const calib::CameraModel& lens) {
  return read<msg::Landmarks>(file, kLandmarks, [&](Row row) { return landmarks_of(row, lens); });
}

Result<void> write_exchange(const fs::path& folder, const std::vector<SensorEvent>& events,
                            const std::vector<Exposure>& exposures, const twin::Twin& twin,
                            const calib::CameraModel& lens) {
  std::string poses = names_of(kPoses), landmarks = names_of(kLandmarks), true_hands = poses,
              true_points = landmarks, images = "image,origin_ns,arrival_ns\n";
  for (const auto& event : events) {
    if (const auto* hands = std::get_if<msg::HandPoses>(&event.message))
      add(*hands, head_of(hands->header.origin_ns, event.arrival_ns), poses);
    if (const auto* found = std::get_if<msg::Landmarks>(&event.message))
      add(*found, head_of(found->header.origin_ns, event.arrival_ns), lens, landmarks);
  }
  for (std::size_t i = 0; i < exposures.size(); ++i) {
    const auto& exposure = exposures[i];
    const auto arrival_ns = twin.camera_arrival_ns(exposure.frame_id);
    const auto head = head_of(exposure.stamp_ns, arrival_ns);
    images += fmt::format("camera/{:06}.png,{},{}\n", i, exposure.stamp_ns, arrival_ns);
    add(true_poses(twin, exposure.origin_ns), head, true_hands);
    add(true_landmarks(twin, exposure.origin_ns), head, lens, true_points);
  }
  for (const auto& [name, text] : {std::pair{"poses.csv", &poses},
                                   {"landmarks.csv", &landmarks},
                                   {"true_poses.csv", &true_hands},
                                   {"true_landmarks.csv", &true_points},
                                   {"images.csv", &images}})
    if (auto written = write_whole(folder / name, *text); !written) return written;
  return {};
}

}  // namespace handcast::simulate
