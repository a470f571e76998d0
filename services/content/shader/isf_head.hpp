// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/content/shader/expression.hpp"
#include "services/content/source.hpp"

namespace handcast::content::shader {

/// An input of an ISF file.
struct IsfInput {
  enum class Type { event, flag, whole, number, point, colour, image, audio, audio_fft };
  Type type = Type::number;
  Parameter parameter;
  /// A point that is set in parts of the picture and that the shader gets in pixels: one without
  /// MIN and MAX.
  bool is_in_pixels = false;
  int most_samples = 0;  ///< of audio: the width of its image; 0: all that there are

  const std::string& name() const { return parameter.name; }
  bool is_image() const { return type >= Type::image; }
};

/// A pass of an ISF file, or a buffer of one of version 1 that no pass draws.
struct IsfPass {
  std::string target;                       ///< the image that it draws; "": the output
  std::optional<Expression> width, height;  ///< px; empty: those of the output
  bool is_persistent = false, is_float = false;
  /// "ONCE", an extension of handcast: it depends on nothing but the settings and the hand at rest,
  /// and is drawn only when those change.
  bool is_drawn_once = false;
};

/// An image that comes with an ISF file.
struct IsfImport {
  std::string name, path;
};

/// What the comment at the start of an ISF file says.
struct IsfHead {
  std::string description;
  std::vector<IsfInput> inputs;
  std::vector<IsfPass> passes;   ///< one or more
  std::vector<IsfPass> buffers;  ///< that no pass draws
  std::vector<IsfImport> imports;

  const IsfInput* input(std::string_view name) const;
};

/// Reads the head of an ISF file of version 1 or 2. Its JSON may have comments, commas at the end
/// of lists and line ends in texts, as that of many files has. Errors (bad_config): there is no
/// head, it is no JSON (with its line), an input of an unknown type, a size that cannot be
/// computed; sentences without the name of the file.
Result<IsfHead> parse_isf_head(std::string_view text);

}  // namespace handcast::content::shader
