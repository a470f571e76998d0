// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/link.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "services/projector/dlp/protocol/payload.hpp"

namespace handcast::dlp {
namespace {

using protocol::Bytes;
using protocol::Command;
using protocol::Direction;
using protocol::Reply;

constexpr int kTries = 2;
/// A device that sends without being asked must not keep the link busy.
constexpr int kMostReports = 32;

std::string about(protocol::Controller controller, Command command) {
  return fmt::format("{}, {}", protocol::name_of(controller), protocol::name_of(command));
}

}  // namespace

/// Replies to commands that were given up would otherwise be read first.
void Link::drop_old_reports() {
  protocol::Report report;
  for (int i = 0; i < kMostReports; ++i)
    if (!device_->read(report, Deadline::now())) return;
}

Result<Reply> Link::try_once(Command command, Direction direction,
                             std::span<const std::uint8_t> data, Deadline deadline) {
  drop_old_reports();
  const auto sequence = sequence_++;
  for (const auto& report : protocol::encode(command, direction, sequence, data))
    if (auto sent = device_->write(report, deadline); !sent)
      return tl::make_unexpected(sent.error());
  protocol::ReplyReader reader(sequence);
  for (int i = 0; i < kMostReports; ++i) {
    protocol::Report report;
    const auto count = device_->read(report, deadline);
    if (!count) return tl::make_unexpected(count.error());
    auto reply = reader.take(std::span(report).first(*count));
    if (!reply) return tl::make_unexpected(reply.error());
    if (*reply) return std::move(**reply);
  }
  return fail(Errc::bad_data, "it sends what nobody has asked for");
}

Result<Reply> Link::exchange(Command command, Direction direction,
                             std::span<const std::uint8_t> data, Deadline deadline) {
  Result<Reply> reply = fail(Errc::timeout, "there is no time left");
  for (int i = 0; i < kTries && !deadline.passed(); ++i) {
    const auto until = Deadline::at_ns(std::min(deadline.time_ns(), now_ns() + kAnswer_ns));
    reply = try_once(command, direction, data, until);
    if (reply && !(reply->refused && direction == Direction::read)) return reply;
    if (!reply && reply.error().code == Errc::disconnected) break;
  }
  if (reply) return reply;
  auto error = reply.error();
  if (error.code == Errc::timeout) error.code = Errc::disconnected;
  return fail_in(about(controller_, command), error);
}

Result<Bytes> Link::read(Command command, std::size_t least, Deadline deadline) {
  auto reply = exchange(command, Direction::read, {}, deadline);
  if (!reply) return tl::make_unexpected(reply.error());
  if (reply->refused)
    return fail(Errc::bad_data, about(controller_, command) + ": it refuses to answer");
  if (reply->data.size() < least)
    return fail(Errc::bad_data,
                fmt::format("{}: it answers with {} bytes instead of {}",
                            about(controller_, command), reply->data.size(), least));
  return std::move(reply->data);
}

/// Why the last command was refused. Only the DLPC900 can tell.
std::string Link::why_refused(Deadline deadline) {
  if (controller_ != protocol::Controller::dlpc900) return {};
  const auto code = read(Command::error_code, 1, deadline);
  return code ? ": " + protocol::explain_error_code(code->front()) : "";
}

Result<void> Link::write(Command command, std::span<const std::uint8_t> data, Deadline deadline) {
  const auto reply = exchange(command, Direction::write, data, deadline);
  if (!reply) return tl::make_unexpected(reply.error());
  if (!reply->refused) return {};
  return fail(Errc::unavailable,
              about(controller_, command) + ": it refuses this" + why_refused(deadline));
}

Result<void> send_all(Link& link, const std::vector<Setting>& settings, Deadline deadline) {
  for (const auto& [command, data] : settings)
    if (auto sent = link.write(command, data, deadline); !sent) return sent;
  return {};
}

}  // namespace handcast::dlp
