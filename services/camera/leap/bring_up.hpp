// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/camera/leap/transfer.hpp"

namespace handcast::camera::leap {

/// A step of a bring-up sequence: a pause, then a control transfer.
struct BringUpStep {
  std::int64_t pause_ns = 0;  ///< before the transfer
  ControlTransfer transfer;   ///< what is sent or read
  int line = 0;               ///< of the file, from 1
};

/// Reads a sequence: one step per line, `#` begins a comment. Numbers are hexadecimal.
///
///     write TYPE REQUEST VALUE INDEX BYTE...     sends the bytes
///     read TYPE REQUEST VALUE INDEX LENGTH       reads LENGTH bytes and ignores them
///     set UNIT SELECTOR VALUE                    sets a control: 16 bits
///     pause MILLISECONDS                         decimal, at most 1000, before the next step
///
/// Errors: bad_config (one line for each fault, with `file` and its line).
Result<std::vector<BringUpStep>> parse_bring_up(std::string_view text, std::string_view file);

/// Reads a file. An empty path: what every controller needs, config/assets/leap/bring_up.txt.
/// Errors: bad_config (it cannot be read, or is too long), those of parse_bring_up().
Result<std::vector<BringUpStep>> load_bring_up(const std::filesystem::path& file);

}  // namespace handcast::camera::leap
