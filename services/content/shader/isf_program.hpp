// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "services/content/shader/hand_view.hpp"
#include "services/content/shader/isf_head.hpp"

namespace handcast::content::shader {

/// An ISF file, read and compiled.
struct IsfProgram {
  std::vector<std::filesystem::path> files;  ///< that it consists of, or might
  IsfHead head;
  std::unique_ptr<HandView> hands;
  std::vector<UserProgram> programs;  ///< one a pass: PASSINDEX is a constant in each
  std::vector<std::string> images;    ///< the names of its images, in the order of their units
  bool is_still = false;              ///< its picture depends on its parameters and images only

  /// Reads FILE.fs and FILE.vs, if there is one. Errors (bad_config): no such file, those of
  /// parse_isf_head(), a compile error with its line.
  static Result<IsfProgram> make(Graphics& graphics, const std::filesystem::path& file,
                                 const Opening& opening);
};

/// The name under which a shader has an input: its own, or, if that is a word of GLSL, with
/// kPrefix.
std::string name_in_glsl(const std::string& name);

}  // namespace handcast::content::shader
