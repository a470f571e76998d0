// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "ipc/control/control_client.hpp"
#include "ipc/control/control_message.hpp"
#include "ipc/control/desk_address.hpp"
#include "ipc/control/pairing.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"

namespace handcast::supervisor {
namespace {

/// Whether the desk of a rig works. Errors: unavailable (the rig or its desk is not up).
Result<void> check_desk(const std::string& rig) {
  const auto answer = control::ask(rig, {.verb = control::Verb::status});
  if (!answer) return tl::make_unexpected(answer.error());
  const auto desk = nlohmann::json::json_pointer("/status/services/desk");
  if (!answer->contains(desk))
    return fail(Errc::unavailable,
                fmt::format("rig '{}' has no desk; its rig file says so in [desk]", rig));
  const auto& service = answer->at(desk);
  const auto state = control::text_at(service, "state"),
             reason = control::text_at(service, "reason");
  if (state == "ready") return {};
  return fail(Errc::unavailable, fmt::format("the desk of rig '{}' is {}{}{}", rig, state,
                                             reason.empty() ? "" : ": ", reason));
}

/// The address of the desk of a rig; with other tokens if `renew`.
Result<control::DeskAddress> desk_of(const std::string& rig, bool renew) {
  const auto file = control::desk_file(rig);
  if (!file) return tl::make_unexpected(file.error());
  auto address = control::read_desk_file(*file);
  if (!address && address.error().code == Errc::unavailable)
    return fail(Errc::unavailable,
                fmt::format("the desk of rig '{}' serves no page: desk.page.listen is empty, or "
                            "the page could not be opened (its log says why)",
                            rig));
  if (!address || !renew) return address;
  address->tokens = control::new_tokens();
  std::error_code absent;  // a code is another way to the tokens
  std::filesystem::remove(control::pairing_file(*file), absent);
  if (const auto written = control::write_desk_file(*file, *address); !written)
    return tl::make_unexpected(written.error());
  return address;
}

/// Prints how another computer gets at the page: the address, a code, and what proves that it is
/// this desk.
int print_lan(const std::string& rig, const control::DeskAddress& desk, control::Role role) {
  if (!desk.lan)
    return complain({Errc::bad_config,
                     fmt::format("the page of rig '{}' is served on this computer alone; write "
                                 "desk.page.lan = \"0.0.0.0:8481\" into its rig file, and "
                                 "`handcast reload`",
                                 rig)});
  const auto& lan = *desk.lan;
  if (!lan.fault.empty()) return complain({Errc::unavailable, lan.fault});
  const auto file = control::desk_file(rig);
  if (!file) return complain(file.error());
  const auto pairing = control::new_pairing(role);
  if (const auto written = control::write_pairing(control::pairing_file(*file), pairing); !written)
    return complain(written.error());
  const auto addresses =
      lan.address == "0.0.0.0" ? control::own_addresses() : std::vector<std::string>{lan.address};
  for (const auto& address : addresses) fmt::print("https://{}:{}/\n", address, lan.port);
  if (addresses.empty()) fmt::print("(this computer is in no network; the port is {})\n", lan.port);
  fmt::print("code {} {}: makes a browser the {}, once, within {} minutes\n",
             pairing.code.substr(0, 4), pairing.code.substr(4),
             control::kRoleNames[static_cast<std::size_t>(role)],
             control::kPairingLasts_ns / 60'000'000'000);
  fmt::print(
      "The browser warns, as nobody else vouches for this computer. Its certificate's "
      "SHA-256 begins\n{}\n",
      lan.fingerprint);
  return kExitDone;
}

control::Role role_named(const std::string& name) {
  for (std::size_t i = 0; i < control::kRoles; ++i)
    if (control::kRoleNames[i] == name) return static_cast<control::Role>(i);
  return control::Role::owner;
}

}  // namespace

int run_desk(const Arguments& arguments) {
  auto line = command_line_of(
      "desk",
      "A viewer looks on; an operator also changes live settings, shows content and works the "
      "cues;\nan owner also saves, and restarts and swaps services. The address holds a token, "
      "which a browser\nkeeps: whoever has it may do the same.");
  std::string rig_name, role = "owner";
  bool renew = false, lan = false;
  line.add("--for viewer|operator|owner", role, "What the person who gets the address may do");
  line.add("--renew", renew, "Makes all addresses that were printed before invalid");
  line.add("--lan", lan,
           "Prints the address for a phone or another computer, and a code to be entered there");
  add_rig(line, rig_name);
  if (const auto code = line.answered(arguments)) return *code;
  const auto rig = choose_rig(rig_name);
  if (!rig) return complain(rig.error());
  if (const auto works = check_desk(*rig); !works) return complain(works.error());
  const auto address = desk_of(*rig, renew);
  if (!address) return complain(address.error());
  if (lan) return print_lan(*rig, *address, role_named(role));
  fmt::print("{}\n", address->url_for(role_named(role)));
  return kExitDone;
}

}  // namespace handcast::supervisor
