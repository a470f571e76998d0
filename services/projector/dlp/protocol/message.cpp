// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/protocol/message.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace handcast::dlp::protocol {
namespace {

constexpr std::uint8_t kReadFlag = 0x80, kReplyFlag = 0x40, kErrorFlag = 0x20;

std::uint8_t low(std::size_t number) { return static_cast<std::uint8_t>(number); }
std::uint8_t high(std::size_t number) { return static_cast<std::uint8_t>(number >> 8); }

}  // namespace

std::vector<Report> encode(Command command, Direction direction, std::uint8_t sequence,
                           std::span<const std::uint8_t> data) {
  const auto number = static_cast<std::size_t>(command);
  const std::size_t length = 2 + data.size();
  Bytes message{
      static_cast<std::uint8_t>(direction == Direction::read ? kReadFlag | kReplyFlag : kReplyFlag),
      sequence,
      low(length),
      high(length),
      low(number),
      high(number)};
  message.insert(message.end(), data.begin(), data.end());
  std::vector<Report> reports((message.size() + kReportBytes - 1) / kReportBytes);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const auto first = i * kReportBytes;
    std::copy_n(message.begin() + static_cast<std::ptrdiff_t>(first),
                std::min(kReportBytes, message.size() - first), reports[i].begin());
  }
  return reports;
}

/// Reads the header of a reply.
Result<void> ReplyReader::begin(std::span<const std::uint8_t> report) {
  if (report.size() < kHeaderBytes)
    return fail(Errc::bad_data, fmt::format("a reply has only {} bytes", report.size()));
  missing_ = report[2] | static_cast<std::size_t>(report[3]) << 8;
  is_stray_ = report[1] != sequence_;
  strays_ += is_stray_;
  if (missing_ > kMostReplyBytes) {
    const auto length = std::exchange(missing_, 0);
    if (is_stray_) return {};
    return fail(Errc::bad_data, fmt::format("a reply claims to have {} bytes", length));
  }
  reply_ = {.refused = (report[0] & kErrorFlag) != 0, .data = {}};
  return {};
}

Result<std::optional<Reply>> ReplyReader::take(std::span<const std::uint8_t> report) {
  auto rest = report;
  if (missing_ == 0) {
    if (auto begun = begin(report); !begun) return tl::make_unexpected(begun.error());
    rest = report.subspan(kHeaderBytes);
  }
  const auto whole = report.size() >= kReportBytes;
  const auto part = rest.first(std::min(missing_, rest.size()));
  missing_ -= part.size();
  if (!is_stray_) reply_.data.insert(reply_.data.end(), part.begin(), part.end());
  if (missing_ > 0 && !whole) {
    const auto lost = std::exchange(missing_, 0);
    if (is_stray_) return std::nullopt;
    return fail(Errc::bad_data, fmt::format("a report of {} bytes ends {} bytes before the reply",
                                            report.size(), lost));
  }
  if (missing_ > 0 || is_stray_) return std::nullopt;
  return std::move(reply_);
}

}  // namespace handcast::dlp::protocol
