// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/stat.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"
#include "ipc/control/desk_address.hpp"
#include "ipc/control/pairing.hpp"
#include "services/desk/page/http_server.hpp"

namespace handcast::desk {

/// Trades the code that `handcast desk --lan` has printed for a role, once. Any thread.
class Pairings {
 public:
  /// After so many wrong codes the right one is no longer valid either: whoever guesses has one
  /// chance in twenty million.
  static constexpr int kMostWrong = 5;

  explicit Pairings(std::filesystem::path file) : file_(std::move(file)) {}

  /// Errors: bad_data (a wrong code), unavailable (none is valid).
  Result<control::Role> trade(std::string_view code);

 private:
  std::filesystem::path file_;
  std::mutex mutex_;
  std::string guessed_;  ///< the code that the wrong ones were tried for
  int wrong_ = 0;
};

/// Takes as long for every text of the same length.
bool is_same_secret(std::string_view a, std::string_view b);

/// Who may do what at the page. Any thread.
class Access {
 public:
  /// Reads the tokens of the rig's file, or makes them. Errors: those of control::desk_file().
  static Result<std::unique_ptr<Access>> open(const std::string& rig);

  /// The port of the page before this service was started again; 0: none.
  std::uint16_t last_port() const;
  /// Writes the file, from which `handcast desk` knows the addresses. `lan`: that for other
  /// computers. Errors: unavailable.
  Result<void> announce(const std::string& address, std::uint16_t port,
                        std::optional<control::LanAddress> lan);
  /// The file's place with another extension (".pem").
  std::filesystem::path beside(const char* extension) const;

  /// Why a request is refused, whoever sends it: it names another computer (a name that was made to
  /// point here, DNS rebinding), or the page of another site sends it. Empty if it is not.
  std::optional<std::string> fault_of(const HttpRequest& request) const;
  /// The role of the one who sends a request, by its cookie or its header Authorization; empty:
  /// unknown.
  std::optional<control::Role> role_of(const HttpRequest& request);
  /// The role of a token; empty: it is none.
  std::optional<control::Role> role_of_token(std::string_view token);
  /// The token for a code that was read off this computer. Errors: those of Pairings::trade().
  Result<std::string> pair(std::string_view code);
  /// The cookie that keeps a token, for the header Set-Cookie of the answer to a request.
  std::string cookie_of(std::string_view token, const HttpRequest& request) const;
  /// Increases whenever `handcast desk --renew` has written other tokens.
  std::uint64_t generation();

 private:
  Access(std::string rig, std::filesystem::path file)
      : rig_(std::move(rig)), file_(std::move(file)), pairings_(control::pairing_file(file_)) {}
  void read_again();
  std::string cookie_name(const HttpRequest& request) const;

  std::string rig_;
  std::filesystem::path file_;
  Pairings pairings_;
  mutable std::mutex mutex_;
  control::DeskAddress address_;
  struct timespec written_ {};  ///< when the file was
  std::uint64_t generation_ = 0;
};

}  // namespace handcast::desk
