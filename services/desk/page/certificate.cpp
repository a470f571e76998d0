// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/certificate.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>
#include <gnutls/x509.h>
#include <sys/stat.h>

#include <array>
#include <ctime>
#include <memory>
#include <span>
#include <type_traits>

#include "ipc/base/input_file.hpp"
#include "ipc/base/log.hpp"
#include "ipc/control/desk_address.hpp"

namespace handcast::desk {
namespace {

constexpr std::time_t kDay_s = 86'400;
/// Some browsers refuse those that are valid for longer than 825 days.
constexpr std::time_t kValid_s = 800 * kDay_s, kRenewed_s = 30 * kDay_s;
constexpr std::size_t kFingerprintBytes = 10;

struct Free {
  void operator()(gnutls_x509_crt_t certificate) const { gnutls_x509_crt_deinit(certificate); }
  void operator()(gnutls_x509_privkey_t key) const { gnutls_x509_privkey_deinit(key); }
};
using Crt = std::unique_ptr<std::remove_pointer_t<gnutls_x509_crt_t>, Free>;
using Key = std::unique_ptr<std::remove_pointer_t<gnutls_x509_privkey_t>, Free>;

Crt new_certificate() {
  gnutls_x509_crt_t certificate = nullptr;
  return Crt(gnutls_x509_crt_init(&certificate) == 0 ? certificate : nullptr);
}

Key new_key() {
  gnutls_x509_privkey_t key = nullptr;
  return Key(gnutls_x509_privkey_init(&key) == 0 ? key : nullptr);
}

/// A text that GnuTLS has written into memory of its own.
std::string taken(int failed, gnutls_datum_t& text) {
  if (failed != 0) return "";
  std::string copy(reinterpret_cast<const char*>(text.data), text.size);
  gnutls_free(text.data);
  return copy;
}

std::string fingerprint_of(gnutls_x509_crt_t certificate) {
  std::array<unsigned char, 32> hash{};
  std::size_t size = hash.size();
  if (gnutls_x509_crt_get_fingerprint(certificate, GNUTLS_DIG_SHA256, hash.data(), &size) != 0)
    return "";
  return fmt::format("{:02X}", fmt::join(std::span(hash).first(kFingerprintBytes), ":"));
}

void add_name(gnutls_x509_crt_t certificate, const std::string& name) {
  in_addr address{};
  if (::inet_pton(AF_INET, name.c_str(), &address) == 1)
    gnutls_x509_crt_set_subject_alt_name(certificate, GNUTLS_SAN_IPADDRESS, &address,
                                         sizeof address, GNUTLS_FSAN_APPEND);
  else
    gnutls_x509_crt_set_subject_alt_name(certificate, GNUTLS_SAN_DNSNAME, name.data(),
                                         static_cast<unsigned>(name.size()), GNUTLS_FSAN_APPEND);
}

/// Fills in a certificate and signs it with its own key. 0, or GnuTLS's error.
int sign(gnutls_x509_crt_t certificate, gnutls_x509_privkey_t key,
         const std::vector<std::string>& names) {
  const std::time_t now = std::time(nullptr);
  std::array<unsigned char, 16> serial{};
  if (const int failed = gnutls_rnd(GNUTLS_RND_NONCE, serial.data(), serial.size())) return failed;
  serial[0] = (serial[0] & 0x3f) | 0x40;  // positive, and of 16 bytes
  for (const auto& name : names) add_name(certificate, name);
  const std::string_view common = "handcast desk";
  for (const int failed :
       {gnutls_x509_crt_set_version(certificate, 3),
        gnutls_x509_crt_set_serial(certificate, serial.data(), serial.size()),
        gnutls_x509_crt_set_dn_by_oid(certificate, GNUTLS_OID_X520_COMMON_NAME, 0, common.data(),
                                      static_cast<unsigned>(common.size())),
        gnutls_x509_crt_set_activation_time(certificate, now - kDay_s),
        gnutls_x509_crt_set_expiration_time(certificate, now + kValid_s),
        gnutls_x509_crt_set_basic_constraints(certificate, 0, -1),
        gnutls_x509_crt_set_key_usage(certificate, GNUTLS_KEY_DIGITAL_SIGNATURE),
        gnutls_x509_crt_set_key_purpose_oid(certificate, GNUTLS_KP_TLS_WWW_SERVER, 0),
        gnutls_x509_crt_set_key(certificate, key)})
    if (failed != 0) return failed;
  return gnutls_x509_crt_sign2(certificate, certificate, key, GNUTLS_DIG_SHA256, 0);
}

Result<Certificate> make(const std::filesystem::path& file, const std::vector<std::string>& names) {
  const auto certificate = new_certificate();
  const auto key = new_key();
  int failed = certificate && key ? 0 : GNUTLS_E_MEMORY_ERROR;
  if (!failed)
    failed = gnutls_x509_privkey_generate(key.get(), GNUTLS_PK_ECDSA,
                                          GNUTLS_CURVE_TO_BITS(GNUTLS_ECC_CURVE_SECP256R1), 0);
  if (!failed) failed = sign(certificate.get(), key.get(), names);
  Certificate made;
  gnutls_datum_t text{};
  if (!failed) {
    made.certificate =
        taken(gnutls_x509_crt_export2(certificate.get(), GNUTLS_X509_FMT_PEM, &text), text);
    made.key = taken(gnutls_x509_privkey_export2(key.get(), GNUTLS_X509_FMT_PEM, &text), text);
    made.fingerprint = fingerprint_of(certificate.get());
  }
  if (made.certificate.empty() || made.key.empty() || made.fingerprint.empty())
    return fail(Errc::unavailable,
                fmt::format("no certificate can be made: {}", gnutls_strerror(failed)));
  const auto written = control::write_private(file, made.certificate + made.key);
  if (!written)
    return fail(Errc::unavailable,
                fmt::format("the certificate of the page cannot be kept, so that no other "
                            "computer may look at it: {}",
                            written.error().what));
  return made;
}

tl::unexpected<Error> unusable(const std::filesystem::path& file, std::string_view why) {
  return fail(Errc::bad_data,
              fmt::format("the certificate of the page, {}, {}; remove the file, and "
                          "`handcast restart desk` makes another one, with another fingerprint",
                          file.string(), why));
}

/// True if a file is of this user, and nobody else may read it.
bool is_private(const std::filesystem::path& file) {
  struct stat status {};
  return ::lstat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
         status.st_uid == ::getuid() && (status.st_mode & 077) == 0;
}

/// True if a key is that of a certificate.
bool fits(gnutls_x509_crt_t certificate, gnutls_x509_privkey_t key) {
  std::array<unsigned char, 64> a{}, b{};
  std::size_t a_size = a.size(), b_size = b.size();
  return gnutls_x509_crt_get_key_id(certificate, 0, a.data(), &a_size) == 0 &&
         gnutls_x509_privkey_get_key_id(key, 0, b.data(), &b_size) == 0 && a_size == b_size &&
         a == b;
}

}  // namespace

Result<Certificate> open_certificate(const std::filesystem::path& file,
                                     const std::vector<std::string>& names) {
  std::error_code unknown;
  // An empty one is of a program that was ended, or of a full disk.
  const bool is_empty = std::filesystem::is_regular_file(file, unknown) &&
                        std::filesystem::file_size(file, unknown) == 0;
  if (!std::filesystem::exists(file, unknown) || is_empty) return make(file, names);
  if (!is_private(file)) return unusable(file, "is not a file of this user alone");
  auto pem = read_input(file, kMostText);
  if (!pem) return unusable(file, "cannot be read");
  const gnutls_datum_t text{reinterpret_cast<unsigned char*>(pem->data()),
                            static_cast<unsigned>(pem->size())};
  const auto certificate = new_certificate();
  const auto key = new_key();
  if (!certificate || !key ||
      gnutls_x509_crt_import(certificate.get(), &text, GNUTLS_X509_FMT_PEM) != 0 ||
      gnutls_x509_privkey_import(key.get(), &text, GNUTLS_X509_FMT_PEM) != 0 ||
      !fits(certificate.get(), key.get()))
    return unusable(file, "is damaged");
  const auto ends = gnutls_x509_crt_get_expiration_time(certificate.get());
  const auto now = std::time(nullptr);
  if (ends < now + kRenewed_s) {
    auto renewed = make(file, names);
    if (renewed || ends < now) return renewed;
    log::warning("the certificate of the page ends soon: {}", renewed.error().what);
  }
  return Certificate{*pem, *pem, fingerprint_of(certificate.get())};
}

}  // namespace handcast::desk
