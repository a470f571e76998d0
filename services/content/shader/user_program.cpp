// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/user_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <glm/glm.hpp>
#include <optional>

namespace handcast::content::shader {
namespace {

/// The versions of GLSL in the order in which they are tried: the one of most shaders; an older
/// one, in which more words are free; one with more functions.
constexpr std::array<int, 3> kVersions{330, 130, 410};

/// Lists in braces, and constants that are computed when a function is called.
const std::string kMoreGlsl = "#extension GL_ARB_shading_language_420pack : enable\n";

/// The numbers of the texts in a driver's messages.
constexpr int kUserText = 0, kOwnText = 1, kCommonText = 2;

std::string assembled(const UserStage& stage, int version) {
  // Before GLSL 3.30, "#line N" numbers the line after the next one.
  const int first = version >= 330 ? 1 : 0;
  std::string extensions = kMoreGlsl + stage.glsl.extensions, common;
  if (stage.common) {
    extensions += stage.common->glsl.extensions;
    common = fmt::format("#line {} {}\n{}\n", first, kCommonText, stage.common->glsl.text);
  }
  return fmt::format("#version {}\n{}#line 1 {}\n{}\n{}#line {} {}\n{}\n#line 1 {}\n{}\n", version,
                     extensions, kOwnText, stage.prelude, common, first, kUserText, stage.glsl.text,
                     kOwnText, stage.epilogue);
}

/// A message of a driver: "0:12(5): error: ...", "0(12) : error C1008: ...", "ERROR: 0:12: ...".
struct DriverMessage {
  int text = kOwnText, line = 0;
  std::string sentence;
};

std::optional<int> take_number(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

std::optional<DriverMessage> read_message(std::string_view line) {
  DriverMessage message;
  for (const std::string_view word : {"ERROR: ", "error: "})
    if (line.starts_with(word)) line.remove_prefix(word.size());
  const auto text = take_number(line);
  if (!text || line.empty() || (line[0] != ':' && line[0] != '(')) return std::nullopt;
  line.remove_prefix(1);
  const auto number = take_number(line);
  if (!number) return std::nullopt;
  message.text = *text;
  message.line = *number;
  if (line.starts_with('(')) line.remove_prefix(std::min(line.find(')'), line.size() - 1));
  line.remove_prefix(std::min(line.find_first_not_of("): "), line.size()));
  message.sentence = line;
  return message;
}

/// The first message about an error; else the first line.
DriverMessage first_error(const std::string& log) {
  std::optional<DriverMessage> first;
  for (std::size_t begin = 0; begin < log.size();) {
    const auto end = std::min(log.find('\n', begin), log.size());
    const auto line = std::string_view(log).substr(begin, end - begin);
    begin = end + 1;
    auto message = read_message(line);
    if (message && message->sentence.find("warning") == std::string::npos) {
      if (message->sentence.starts_with("error: ")) message->sentence.erase(0, 7);
      return *message;
    }
    if (!message && !first && line.find_first_not_of(" \t") != line.npos)
      first = DriverMessage{kOwnText, 0, std::string(line)};
  }
  return first.value_or(DriverMessage{kOwnText, 0, "the driver gives no reason"});
}

std::string_view line_of(std::string_view text, int number) {
  for (int line = 1; line < number; ++line) {
    const auto end = text.find('\n');
    if (end == text.npos) return {};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find_first_of("\r\n"));
  const auto begin = text.find_first_not_of(" \t");
  return begin == text.npos ? std::string_view() : text.substr(begin, 100);
}

/// Takes the prefix off the names that the person knows without it.
std::string readable(std::string sentence) {
  for (auto at = sentence.find(kPrefix); at != sentence.npos; at = sentence.find(kPrefix, at))
    sentence.erase(at, kPrefix.size());
  return sentence;
}

tl::unexpected<Error> compile_error(const UserStage& stage, const std::string& log) {
  const auto message = first_error(log);
  const bool is_common = message.text == kCommonText && stage.common;
  const UserText& text = is_common ? *stage.common : stage;
  const auto name = text.file.filename().string();
  if (message.text != kUserText && !is_common)
    return fail(Errc::bad_config, fmt::format("{}: {}", name, readable(message.sentence)));
  const auto line = line_of(text.original, message.line);
  return fail(Errc::bad_config,
              fmt::format("{}:{}: {}{}{}", name, message.line, readable(message.sentence),
                          line.empty() ? "" : ": ", line));
}

Result<void> compile(Graphics& graphics, const gl::Program& program, GLenum kind,
                     const UserStage& stage, int version) {
  const auto& gl = graphics.functions();
  const auto text = assembled(stage, version);
  const GLchar* const data = text.data();
  const auto length = static_cast<GLint>(text.size());
  const GLuint shader = gl.CreateShader(kind);
  gl.ShaderSource(shader, 1, &data, &length);
  gl.CompileShader(shader);
  GLint is_good = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
  if (is_good) {
    gl.AttachShader(program.name(), shader);
  } else {
    std::string log(4000, '\0');
    GLsizei bytes = 0;
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &bytes, log.data());
    log.resize(static_cast<std::size_t>(std::max(0, bytes)));
    gl.DeleteShader(shader);
    return compile_error(stage, log);
  }
  gl.DeleteShader(shader);  // with the program
  return {};
}

Result<gl::Program> build(Graphics& graphics, const UserStage& fragment, const UserStage& vertex,
                          int version) {
  const auto& gl = graphics.functions();
  gl::Program program(graphics.context(), gl.CreateProgram());
  if (auto good = compile(graphics, program, GL_FRAGMENT_SHADER, fragment, version); !good)
    return tl::make_unexpected(good.error());
  if (auto good = compile(graphics, program, GL_VERTEX_SHADER, vertex, version); !good)
    return tl::make_unexpected(good.error());
  gl.LinkProgram(program.name());
  GLint is_good = GL_FALSE;
  gl.GetProgramiv(program.name(), GL_LINK_STATUS, &is_good);
  if (is_good) return program;
  std::string log(4000, '\0');
  GLsizei bytes = 0;
  gl.GetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), &bytes, log.data());
  log.resize(static_cast<std::size_t>(std::max(0, bytes)));
  return compile_error(fragment, log);
}

}  // namespace

UserStage plain_vertex_stage() {
  UserStage stage;
  stage.glsl.text =
      "void main() {\n"
      "  gl_Position = vec4(2 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID >> 1) - 1, 0.0, 1.0);\n}\n";
  return stage;
}

Result<UserProgram> UserProgram::make(Graphics& graphics, const UserStage& fragment,
                                      const UserStage& vertex,
                                      std::span<const std::string> samplers) {
  const auto text = assembled(fragment, 0) + assembled(vertex, 0);
  std::erase_if(graphics.programs(), [](const auto& each) { return each.second.expired(); });
  auto& shared = graphics.programs()[text];
  if (auto known = shared.lock()) return UserProgram(graphics, std::move(known));
  std::optional<Error> first;
  for (const int version : kVersions) {
    auto program = build(graphics, fragment, vertex, version);
    if (!program) {
      if (!first) first = program.error();
      continue;
    }
    UserProgram made(graphics, std::make_shared<const gl::Program>(std::move(*program)));
    shared = made.program_;
    for (std::size_t unit = 0; unit < samplers.size(); ++unit)
      made.set(samplers[unit], static_cast<int>(unit));
    return made;
  }
  return tl::make_unexpected(*first);
}

GLint UserProgram::location(const std::string& uniform) const {
  const auto [found, is_new] = locations_.try_emplace(uniform, -1);
  if (is_new) found->second = graphics_->functions().GetUniformLocation(name(), uniform.c_str());
  return found->second;
}

void UserProgram::set(const std::string& uniform, int value) const {
  if (const auto at = location(uniform); at >= 0)
    graphics_->functions().ProgramUniform1i(name(), at, value);
}
void UserProgram::set(const std::string& uniform, float value) const {
  if (const auto at = location(uniform); at >= 0)
    graphics_->functions().ProgramUniform1f(name(), at, value);
}
void UserProgram::set(const std::string& uniform, glm::vec2 value) const {
  set(uniform, std::span(&value, 1));
}
void UserProgram::set(const std::string& uniform, glm::vec3 value) const {
  set(uniform, std::span(&value, 1));
}
void UserProgram::set(const std::string& uniform, glm::vec4 value) const {
  if (const auto at = location(uniform); at >= 0)
    graphics_->functions().ProgramUniform4fv(name(), at, 1, &value[0]);
}
void UserProgram::set(const std::string& uniform, std::span<const glm::vec2> values) const {
  if (const auto at = location(uniform); at >= 0)
    graphics_->functions().ProgramUniform2fv(name(), at, static_cast<GLsizei>(values.size()),
                                             &values[0][0]);
}
void UserProgram::set(const std::string& uniform, std::span<const glm::vec3> values) const {
  if (const auto at = location(uniform); at >= 0)
    graphics_->functions().ProgramUniform3fv(name(), at, static_cast<GLsizei>(values.size()),
                                             &values[0][0]);
}

}  // namespace handcast::content::shader
