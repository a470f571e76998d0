// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::desk {

/// What the page is encrypted with: PEM texts. A browser does not know who made the certificate,
/// so people compare its fingerprint.
struct Certificate {
  std::string certificate, key;
  std::string fingerprint;  ///< the first 10 bytes of its SHA-256, "AB:CD:…"
};

/// Reads the certificate of a file, or makes one and keeps it there, for this user alone.
/// `names`: of this computer, addresses too. One that ends within a month is replaced. Errors:
/// bad_data (it is damaged, or others may read it), unavailable (the file cannot be written).
Result<Certificate> open_certificate(const std::filesystem::path& file,
                                     const std::vector<std::string>& names);

}  // namespace handcast::desk
