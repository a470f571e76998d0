// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/isf_program.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/input_file.hpp"

namespace handcast::content::shader {
namespace {

namespace fs = std::filesystem;
using Type = IsfInput::Type;

/// What every shader has, in both stages.
constexpr std::string_view kBuiltIns = R"(
uniform vec2 RENDERSIZE;
uniform float TIME, TIMEDELTA;
uniform vec4 DATE;
uniform int FRAMEINDEX;
vec4 hc_at(sampler2D image, vec2 place) { return texture(image, place); }
vec4 hc_at(sampler2D image, vec2 place, float bias) { return texture(image, place); }
vec2 hc_size(sampler2D image) { return vec2(textureSize(image, 0)); }
vec4 hc_rect(sampler2D image, vec2 place) { return hc_at(image, place / hc_size(image)); }
#define IMG_NORM_PIXEL hc_at
#define IMG_PIXEL hc_rect
#define IMG_THIS_PIXEL(image) hc_at(image, isf_FragNormCoord)
#define IMG_THIS_NORM_PIXEL(image) hc_at(image, isf_FragNormCoord)
#define IMG_SIZE hc_size
#define texture2D hc_at
#define texture2DRect hc_rect
#define sampler2DRect sampler2D
#define vv_FragNormCoord isf_FragNormCoord
#define vv_vertShaderInit isf_vertShaderInit
)";

constexpr std::string_view kFragmentPrelude = R"(
in vec2 isf_FragNormCoord;
float hc_finite(float value) { return abs(value) <= 3.0e38 ? value : 0.0; }
)";
constexpr std::string_view kVertexPrelude = R"(
out vec2 isf_FragNormCoord;
void isf_vertShaderInit() {
  isf_FragNormCoord = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(2.0 * isf_FragNormCoord - 1.0, 0.0, 1.0);
}
)";
constexpr std::string_view kVertexEpilogue = "void main() { isf_vertShaderInit(); hc_main(); }\n";

std::string_view glsl_type_of(Type type) {
  switch (type) {
    case Type::event:
    case Type::flag:
      return "bool";
    case Type::whole:
      return "int";
    case Type::number:
      return "float";
    case Type::point:
      return "vec2";
    case Type::colour:
      return "vec4";
    case Type::image:
    case Type::audio:
    case Type::audio_fft:
      break;
  }
  return "sampler2D";
}

/// The names of all images, each once.
std::vector<std::string> images_of(const IsfHead& head) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const auto& input : head.inputs)
    if (input.is_image()) add(input.name());
  for (const auto& import : head.imports) add(import.name);
  for (const auto* passes : {&head.passes, &head.buffers})
    for (const auto& pass : *passes) add(pass.target);
  return names;
}

std::string declarations_of(const IsfHead& head, const std::vector<std::string>& images) {
  std::string text;
  for (const auto& input : head.inputs)
    if (!input.is_image())
      text += fmt::format("uniform {} {};\n", glsl_type_of(input.type), name_in_glsl(input.name()));
  for (const auto& image : images) {
    const auto name = name_in_glsl(image);
    text += fmt::format(
        "uniform sampler2D {0};\n#define _{1}_imgSize hc_size({0})\n"
        "#define _{1}_imgRect vec4(0.0, 0.0, 1.0, 1.0)\n#define _{1}_flip false\n",
        name, image);
  }
  return text;
}

/// Numbers that are not finite come out as 0.
std::string fragment_epilogue(const std::string& output) {
  if (output.empty()) return "void main() { hc_main(); }\n";
  return fmt::format(
      "void main() {{ hc_main(); {0} = vec4(hc_finite({0}.r), hc_finite({0}.g), hc_finite({0}.b), "
      "hc_finite({0}.a)); }}\n",
      output);
}

bool depends_on_settings_alone(const std::set<std::string, std::less<>>& words, const IsfHead& head,
                               const HandView& hands) {
  for (const auto* const word : {"TIME", "TIMEDELTA", "DATE", "FRAMEINDEX"})
    if (words.contains(word)) return false;
  const auto changes = [](const IsfPass& pass) { return pass.is_persistent; };
  const auto moves = [](const IsfInput& input) {
    return input.type == Type::event || input.type >= Type::audio;
  };
  return !hands.is_live() && std::ranges::none_of(head.passes, changes) &&
         std::ranges::none_of(head.inputs, moves);
}

}  // namespace

std::string name_in_glsl(const std::string& name) {
  return is_glsl_word(name) ? std::string(kPrefix) + name : name;
}

Result<IsfProgram> IsfProgram::make(Graphics& graphics, const fs::path& file,
                                    const Opening& opening) {
  IsfProgram made;
  auto vertex_file = file;
  vertex_file.replace_extension(".vs");
  made.files = {file, vertex_file};
  constexpr std::size_t kMostBytes = 4 << 20;
  auto text = read_input(file, kMostBytes);
  if (!text) return tl::make_unexpected(text.error());
  const auto name = file.filename().string();
  auto head = parse_isf_head(*text);
  if (!head) return fail_in(name, head.error());
  made.head = std::move(*head);
  for (const auto& import : made.head.imports)
    made.files.push_back(file.parent_path() / import.path);

  std::set<std::string, std::less<>> renamed;
  for (const auto& input : made.head.inputs)
    if (is_glsl_word(input.name())) renamed.insert(input.name());
  UserStage fragment{{file, *text, read_glsl(*text, renamed)}}, vertex;
  vertex.glsl.text = "void hc_main() {}\n";
  std::error_code absent;
  if (fs::exists(vertex_file, absent)) {
    auto vertex_text = read_input(vertex_file, kMostBytes);
    if (!vertex_text) return tl::make_unexpected(vertex_text.error());
    vertex = {{vertex_file, *vertex_text, read_glsl(*vertex_text, renamed)}};
  }
  auto words = fragment.glsl.words;
  words.insert(vertex.glsl.words.begin(), vertex.glsl.words.end());
  made.hands = std::make_unique<HandView>(words, opening);
  made.images = images_of(made.head);
  made.is_still = depends_on_settings_alone(words, made.head, *made.hands);

  const auto common =
      std::string(kBuiltIns) + declarations_of(made.head, made.images) + made.hands->declarations();
  fragment.epilogue = fragment_epilogue(fragment.glsl.output);
  vertex.epilogue = kVertexEpilogue;
  std::vector<std::string> samplers;
  for (const auto& image : made.images) samplers.push_back(name_in_glsl(image));
  std::ranges::copy(made.hands->samplers(), std::back_inserter(samplers));
  for (std::size_t pass = 0; pass < made.head.passes.size(); ++pass) {
    const auto prelude = fmt::format("const int PASSINDEX = {};\n{}", pass, common);
    fragment.prelude = std::string(kFragmentPrelude) + prelude;
    vertex.prelude = std::string(kVertexPrelude) + prelude;
    auto program = UserProgram::make(graphics, fragment, vertex, samplers);
    if (!program) return tl::make_unexpected(program.error());
    made.programs.push_back(std::move(*program));
  }
  return made;
}

}  // namespace handcast::content::shader
