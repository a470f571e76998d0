// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/content/shader/user_program.hpp"

namespace handcast::content::shader {

inline constexpr int kShadertoyBuffers = 4, kShadertoyChannels = 4;

/// What a part of a program reads as iChannel0 to iChannel3.
struct ShadertoyChannel {
  enum class From { nothing, buffer, input, picture, sound };
  enum class Wrap { clamp, repeat, mirror };
  From from = From::nothing;
  int buffer = 0;                 ///< 0 is A
  std::filesystem::path picture;  ///< a PNG or JPEG file
  Wrap wrap = Wrap::clamp;
  bool is_nearest = false;  ///< else linear
};

/// The image or a buffer.
struct ShadertoyPart : UserText {
  std::array<ShadertoyChannel, kShadertoyChannels> channels;
};

/// A program by the conventions of Shadertoy: a file with mainImage(). Its parts begin with the
/// lines "//! common", "//! buffer A" to "//! buffer D" and "//! image"; or they are files beside
/// it, NAME.common.frag and NAME.a.frag to NAME.d.frag beside NAME.frag. Channels are stated by
/// lines in a part, or in what is common for all parts that state none:
///
///     //! iChannel0 = buffer A | input | sound | none | FILE.png  [linear|nearest]
///     [clamp|repeat|mirror]
///
/// Without such lines, iChannel0 to iChannel3 are the buffers A to D. Buffers and the input are
/// linear and clamped, pictures linear and repeated.
struct ShadertoyProgram {
  std::vector<std::filesystem::path> files;  ///< that it consists of, or might
  std::optional<UserText> common;
  std::array<std::optional<ShadertoyPart>, kShadertoyBuffers> buffers;
  ShadertoyPart image;

  /// All parts in the order in which they are drawn.
  std::vector<const ShadertoyPart*> parts() const;
  /// True if a channel of a part is from there.
  bool reads(ShadertoyChannel::From from) const;
  /// The identifiers of all parts.
  std::set<std::string, std::less<>> words() const;
};

/// Reads it. Errors (bad_config): those of read_input(), a line "//! ..." that makes no sense, no
/// image, a part without mainImage(); sentences that begin with the name of the file.
Result<ShadertoyProgram> read_shadertoy(const std::filesystem::path& file);

}  // namespace handcast::content::shader
