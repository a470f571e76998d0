// SPDX-License-Identifier: Apache-2.0
#include "services/desk/lamp/pjlink.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <optional>

#include "ipc/base/input_file.hpp"
#include "ipc/base/quote.hpp"
#include "services/desk/lamp/connection.hpp"
#include "services/desk/lamp/md5.hpp"

namespace handcast::desk::lamp {
namespace {

constexpr std::string_view kPort = "4352";
constexpr std::size_t kLongestPassword = 32;

std::string name_of(const Place& place) {
  return fmt::format("the projector at {}:{}", place.host, place.port);
}

/// An answer that is no value.
enum class Refusal {
  unknown,    ///< ERR1: the command
  bad_value,  ///< ERR2
  not_now,    ///< ERR3: in standby, or while it warms up
  is_broken,  ///< ERR4
};
/// A value, or why there is none.
using Answer = tl::expected<std::string, Refusal>;

/// A connection on which the password has been agreed.
class Session {
 public:
  static Result<Session> open(const Place& place, Deadline deadline, const std::stop_token& stop) {
    auto connection = Connection::open(place.host, place.port, deadline, stop);
    if (!connection) return tl::make_unexpected(connection.error());
    Session session(place, std::move(*connection));
    if (const auto greeted = session.greet(); !greeted) return tl::make_unexpected(greeted.error());
    return session;
  }

  /// Sends "POWR ?" or "POWR 1" and takes its answer.
  Result<Answer> call(std::string_view command, std::string_view value) {
    if (const auto sent =
            connection_.write(fmt::format("{}%1{} {}", std::exchange(digest_, {}), command, value));
        !sent)
      return tl::make_unexpected(sent.error());
    auto line = connection_.read();
    if (!line) return tl::make_unexpected(line.error());
    if (*line == "PJLINK ERRA") return wrong_password();
    const auto head = fmt::format("%1{}=", command);
    if (!line->starts_with(head)) return no_pjlink(*line);
    auto answer = line->substr(head.size());
    constexpr std::array<std::string_view, 4> kRefusals{"ERR1", "ERR2", "ERR3", "ERR4"};
    const auto refusal = std::ranges::find(kRefusals, answer);
    if (refusal == kRefusals.end()) return Answer(std::move(answer));
    return Answer(tl::make_unexpected(static_cast<Refusal>(refusal - kRefusals.begin())));
  }

  /// The same for an answer that must be a value. Errors: also unavailable, bad_config, bad_data.
  Result<std::string> need(std::string_view command, std::string_view value) {
    auto answer = call(command, value);
    if (!answer) return tl::make_unexpected(answer.error());
    if (*answer) return std::move(**answer);
    return refused(command, value, answer->error());
  }
  tl::unexpected<Error> refused(std::string_view command, std::string_view value,
                                Refusal refusal) const {
    const auto what = fmt::format("{} {}", command, value);
    switch (refusal) {
      case Refusal::unknown:
        return fail(Errc::bad_config, fmt::format("{} has no command {}", name_of(place_), what));
      case Refusal::bad_value:
        return fail(Errc::bad_config,
                    fmt::format("{} does not know the value of {}{}", name_of(place_), what,
                                command == "INPT" ? "; check projector.lamp.input" : ""));
      case Refusal::not_now:
        return fail(Errc::unavailable, fmt::format("{} cannot do {} now", name_of(place_), what));
      case Refusal::is_broken:
        break;
    }
    return fail(Errc::bad_data, fmt::format("{} reports a fault; `handcast lamp status` lists it",
                                            name_of(place_)));
  }

 private:
  Session(const Place& place, Connection connection)
      : place_(place), connection_(std::move(connection)) {}

  /// Takes "PJLINK 0", or "PJLINK 1 " and what the password is mixed with.
  Result<void> greet() {
    const auto line = connection_.read();
    if (!line) return tl::make_unexpected(line.error());
    if (*line == "PJLINK 0") return {};
    if (*line == "PJLINK ERRA") return wrong_password();
    constexpr std::string_view kSalted = "PJLINK 1 ";
    if (!line->starts_with(kSalted) || line->size() == kSalted.size()) return no_pjlink(*line);
    if (place_.password.empty())
      return fail(Errc::bad_config,
                  fmt::format("{} asks for a password; write it into a file, and name that in "
                              "projector.lamp.password_file",
                              name_of(place_)));
    digest_ = md5(line->substr(kSalted.size()) + place_.password);
    return {};
  }

  tl::unexpected<Error> wrong_password() const {
    return fail(Errc::bad_config,
                fmt::format("{} refuses the password; it is the one of PJLink in its menu",
                            name_of(place_)));
  }
  tl::unexpected<Error> no_pjlink(std::string_view line) const {
    return fail(Errc::bad_data, fmt::format("{} does not speak PJLink: it says {}", name_of(place_),
                                            quote(line.substr(0, 40))));
  }

  Place place_;
  Connection connection_;
  std::string digest_;  ///< goes before the first command
};

Result<Status::Power> power_of(Session& session) {
  const auto answer = session.need("POWR", "?");
  if (!answer) return tl::make_unexpected(answer.error());
  if (answer->size() == 1 && answer->front() >= '0' && answer->front() <= '3')
    return static_cast<Status::Power>(answer->front() - '0');
  return fail(Errc::bad_data, fmt::format("the projector's power is {}, which PJLink does not know",
                                          quote(answer->substr(0, 40))));
}

/// What a projector may refuse to say, e.g. in standby: "" then.
Result<std::string> value_if_known(Session& session, std::string_view command) {
  auto answer = session.call(command, "?");
  if (!answer) return tl::make_unexpected(answer.error());
  return *answer ? std::move(**answer) : "";
}

std::vector<Status::Hours> read_hours(std::string_view text) {
  std::vector<Status::Hours> lamps;
  const char *at = text.data(), *const end = at + text.size();
  while (at < end) {
    Status::Hours lamp;
    int on = 0;
    const auto hours = std::from_chars(at, end, lamp.hours);
    if (hours.ec != std::errc() || hours.ptr == end) break;
    const auto is_on = std::from_chars(hours.ptr + 1, end, on);
    if (is_on.ec != std::errc()) break;
    lamp.is_on = on == 1;
    lamps.push_back(lamp);
    at = is_on.ptr + 1;
  }
  return lamps;
}

std::vector<std::string> read_faults(std::string_view digits) {
  constexpr std::array<std::string_view, 6> kParts{"fan",   "lamp",   "temperature",
                                                   "cover", "filter", "something else"};
  std::vector<std::string> faults;
  for (std::size_t i = 0; i < std::min(digits.size(), kParts.size()); ++i)
    if (digits[i] == '1' || digits[i] == '2')
      faults.push_back(fmt::format("{}: {}", kParts[i], digits[i] == '1' ? "warning" : "error"));
  return faults;
}

/// Opens or closes the shutter. Some projectors only know that of the picture without the sound.
Result<void> mute(Session& session, bool on) {
  const auto both = session.call("AVMT", on ? "31" : "30");
  if (!both) return tl::make_unexpected(both.error());
  if (*both) return {};
  if (both->error() != Refusal::bad_value) return session.refused("AVMT", "", both->error());
  return session.need("AVMT", on ? "11" : "10").map([](const auto&) {});
}

/// With the lamp on.
Result<void> set_picture(Session& session, config::Lamp wanted, std::string_view input) {
  const auto muted = value_if_known(session, "AVMT");
  if (!muted) return tl::make_unexpected(muted.error());
  const bool is_muted = *muted == "31" || *muted == "11";
  if (is_muted != (wanted == config::Lamp::mute))
    if (auto done = mute(session, !is_muted); !done) return done;
  if (input.empty()) return {};
  const auto chosen = value_if_known(session, "INPT");
  if (!chosen) return tl::make_unexpected(chosen.error());
  if (*chosen == input) return {};
  return session.need("INPT", input).map([](const auto&) {});
}

/// The first line of a file that only this user can read.
Result<std::string> read_password(const std::string& file) {
  const auto wrong = [&](std::string_view why) {
    return fail(Errc::bad_config, fmt::format("projector.lamp.password_file: {} {}", file, why));
  };
  struct stat found {};
  constexpr std::uint64_t kMostBytes = 4096;
  const auto text = read_input(file, kMostBytes);
  if (::stat(file.c_str(), &found) != 0 || !text || text->empty())
    return wrong("cannot be read, or is empty");
  std::string password = text->substr(0, text->find('\n'));
  if ((found.st_mode & 077) != 0) return wrong("can be read by others; `chmod 600` makes it yours");
  while (!password.empty() && (password.back() == '\r' || password.back() == ' '))
    password.pop_back();
  if (password.size() > kLongestPassword)
    return wrong("has more than the 32 characters of a PJLink password");
  return password;
}

}  // namespace

std::string_view words_for(Status::Power power) {
  constexpr std::array<std::string_view, 4> kWords{"off", "on", "cooling down", "warming up"};
  return kWords.at(static_cast<std::size_t>(power));
}

Result<Place> place_of(const config::ProjectorLamp& settings) {
  std::string_view host = settings.pjlink;
  if (host.empty())
    return fail(Errc::bad_config,
                "projector.lamp.pjlink: it is empty; write the address of the projector into the "
                "rig file");
  Place place{"", std::string(kPort), ""};
  const auto colon = host.rfind(':');
  const bool has_port = colon != host.npos && (host.find(':') == colon || host[colon - 1] == ']');
  if (has_port) {
    place.port = host.substr(colon + 1);
    host = host.substr(0, colon);
  }
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  place.host = host;
  if (host.empty() || place.port.empty() ||
      place.port.find_first_not_of("0123456789") != place.port.npos)
    return fail(Errc::bad_config, fmt::format("projector.lamp.pjlink: {} is no HOST or HOST:PORT",
                                              quote(settings.pjlink)));
  const char* known = std::getenv("HANDCAST_PJLINK_PASSWORD");
  if (settings.password_file.empty()) {
    place.password = known ? known : "";
    return place;
  }
  auto password = read_password(settings.password_file);
  if (!password) return tl::make_unexpected(password.error());
  place.password = std::move(*password);
  return place;
}

Result<Status> ask(const Place& place, Deadline deadline, const std::stop_token& stop) {
  auto session = Session::open(place, deadline, stop);
  if (!session) return tl::make_unexpected(session.error());
  const auto power = power_of(*session);
  if (!power) return tl::make_unexpected(power.error());
  Status status{.power = *power};
  std::array<std::string, 5> said;
  constexpr std::array<std::string_view, 5> kCommands{"NAME", "AVMT", "INPT", "LAMP", "ERST"};
  for (std::size_t i = 0; i < kCommands.size(); ++i) {
    auto value = value_if_known(*session, kCommands[i]);
    if (!value) return tl::make_unexpected(value.error());
    said[i] = std::move(*value);
  }
  status.name = said[0];
  status.is_muted = said[1] == "31" || said[1] == "11";
  status.input = said[2];
  status.lamps = read_hours(said[3]);
  status.faults = read_faults(said[4]);
  return status;
}

Result<bool> tell(const Place& place, config::Lamp wanted, std::string_view input,
                  Deadline deadline, const std::stop_token& stop) {
  using Power = Status::Power;
  if (wanted == config::Lamp::unchanged) return true;
  auto session = Session::open(place, deadline, stop);
  if (!session) return tl::make_unexpected(session.error());
  const auto power = power_of(*session);
  if (!power) return tl::make_unexpected(power.error());
  if (wanted == config::Lamp::off) {
    if (*power == Power::off || *power == Power::cooling) return true;
    const auto done = session->call("POWR", "0");
    if (!done) return tl::make_unexpected(done.error());
    if (*done) return true;
    if (done->error() == Refusal::not_now) return false;
    return session->refused("POWR", "0", done->error());
  }
  if (*power == Power::on) return set_picture(*session, wanted, input).map([] { return true; });
  if (*power == Power::warming) return false;
  const auto done = session->call("POWR", "1");
  if (!done) return tl::make_unexpected(done.error());
  if (*done || done->error() == Refusal::not_now) return false;
  return session->refused("POWR", "1", done->error());
}

}  // namespace handcast::desk::lamp
