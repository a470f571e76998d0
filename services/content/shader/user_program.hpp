// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/content/shader/glsl_text.hpp"
#include "services/content/shader/graphics.hpp"

namespace handcast::content::shader {

/// A text of a person's program.
struct UserText {
  std::filesystem::path file;  ///< for messages
  std::string original;        ///< as in the file, for messages
  GlslText glsl;
};

/// One stage of a person's program.
struct UserStage : UserText {
  std::string prelude, epilogue;     ///< what stands before and behind its texts
  std::optional<UserText> common{};  ///< before its own
};

/// A program of a fragment shader and perhaps a vertex shader that a person wrote. In its
/// vertex stage there are four vertices, the corners of the picture.
class UserProgram {
 public:
  /// No program.
  UserProgram() = default;
  /// Compiles it, by the version of GLSL that takes it. `common`: of both preludes, after the
  /// version. `samplers`: the names of its images, in the order of their units. Errors
  /// (bad_config): "FILE:LINE: message", with the text of the line. Programs of the same text share
  /// what was compiled, so set all uniforms for each picture.
  static Result<UserProgram> make(Graphics& graphics, const UserStage& fragment,
                                  const UserStage& vertex, std::span<const std::string> samplers);

  /// The program of OpenGL.
  GLuint name() const { return program_->name(); }
  /// Where a uniform is; -1 if the program does not use it.
  GLint location(const std::string& uniform) const;
  /// Sets a uniform; nothing happens if the program does not use it.
  /// @{
  void set(const std::string& uniform, int value) const;
  void set(const std::string& uniform, float value) const;
  void set(const std::string& uniform, glm::vec2 value) const;
  void set(const std::string& uniform, glm::vec3 value) const;
  void set(const std::string& uniform, glm::vec4 value) const;
  void set(const std::string& uniform, std::span<const glm::vec2> values) const;
  void set(const std::string& uniform, std::span<const glm::vec3> values) const;
  /// @}

 private:
  UserProgram(Graphics& graphics, std::shared_ptr<const gl::Program> program)
      : graphics_(&graphics), program_(std::move(program)) {}

  Graphics* graphics_ = nullptr;
  std::shared_ptr<const gl::Program> program_;
  mutable std::map<std::string, GLint> locations_;
};

/// The vertex stage of a program that has none of its own.
UserStage plain_vertex_stage();

}  // namespace handcast::content::shader
