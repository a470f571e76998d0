// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gnutls/gnutls.h>

#include <array>
#include <chrono>
#include <string>
#include <string_view>

#include "tests/services/desk/page/http_client.hpp"

namespace handcast::test {

/// An encrypted connection to a port of this computer, which believes any certificate.
class TlsWire {
 public:
  explicit TlsWire(std::uint16_t port) : wire_(port) {
    gnutls_certificate_allocate_credentials(&credentials_);
    gnutls_init(&session_, GNUTLS_CLIENT);
    gnutls_set_default_priority(session_);
    gnutls_credentials_set(session_, GNUTLS_CRD_CERTIFICATE, credentials_);
    gnutls_transport_set_int(session_, wire_.fd());
    gnutls_handshake_set_timeout(session_, 20'000);
    int done = GNUTLS_E_AGAIN;
    while (done < 0 && gnutls_error_is_fatal(done) == 0) done = gnutls_handshake(session_);
    is_open_ = done == 0;
  }
  TlsWire(const TlsWire&) = delete;
  TlsWire& operator=(const TlsWire&) = delete;
  ~TlsWire() {
    gnutls_deinit(session_);
    gnutls_certificate_free_credentials(credentials_);
  }

  bool is_open() const { return is_open_; }
  void send(std::string_view bytes) {
    if (is_open_) gnutls_record_send(session_, bytes.data(), bytes.size());
  }
  /// Receives until the other end closes, or `text` has come.
  std::string receive(std::string_view text = "") {
    std::string all;
    std::array<char, 1 << 14> bytes;
    while (is_open_ && (text.empty() || all.find(text) == std::string::npos)) {
      const auto count = gnutls_record_recv(session_, bytes.data(), bytes.size());
      if (count == GNUTLS_E_INTERRUPTED || count == GNUTLS_E_AGAIN) continue;
      if (count <= 0) break;
      all.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return all;
  }
  /// The certificate of the other end, DER; "" if there is none.
  std::string certificate() const {
    unsigned count = 0;
    const auto* all = gnutls_certificate_get_peers(session_, &count);
    return count == 0 ? "" : std::string(reinterpret_cast<const char*>(all[0].data), all[0].size);
  }

 private:
  Wire wire_;
  gnutls_session_t session_ = nullptr;
  gnutls_certificate_credentials_t credentials_ = nullptr;
  bool is_open_ = false;
};

inline Answer ask_encrypted(std::uint16_t port, std::string_view method, std::string_view path,
                            const HttpHeaders& headers = {}, std::string_view body = "") {
  TlsWire wire(port);
  wire.send(request_text(port, method, path, headers, body));
  return parse_answer(wire.receive());
}

}  // namespace handcast::test
