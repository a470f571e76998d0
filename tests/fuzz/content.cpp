// SPDX-License-Identifier: Apache-2.0
// A text that a person gives for content: a chain of sources, the head of an ISF file with the
// sizes of its passes, and a program by the conventions of Shadertoy. Each input is read as all of
// them. Limits: 10 s and 1 GB per input.
#include "config/content_chain.hpp"
#include "services/content/shader/isf_head.hpp"
#include "services/content/shader/shadertoy_text.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace handcast;
using namespace handcast::content;

template <class T>
bool is_told(const Result<T>& result) {
  return result || (result.error().code == Errc::bad_config && !result.error().what.empty());
}

/// A chain that was read is the same after it was printed and read again.
void read_chain(std::string_view text) {
  const auto chain = config::parse_content(text);
  fuzz::require(is_told(chain));
  fuzz::require(is_told(config::resolve_content(text, "/folder")));
  if (!chain) return;
  const auto printed = config::print_content(*chain);
  const auto again = config::parse_content(printed);
  fuzz::require(again && config::print_content(*again) == printed);
}

void read_isf(std::string_view text) {
  const auto head = shader::parse_isf_head(text);
  fuzz::require(is_told(head));
  if (!head) return;
  fuzz::require(!head->passes.empty());
  const auto value_of = [](std::string_view name) {
    return std::optional<double>(static_cast<double>(name.size()));
  };
  for (const auto* passes : {&head->passes, &head->buffers})
    for (const auto& pass : *passes)
      for (const auto* size : {&pass.width, &pass.height})
        if (*size) (void)(*size)->value(value_of);
  for (const auto& input : head->inputs) {
    const auto& parameter = input.parameter;
    fuzz::require(!input.name().empty() && parameter.values.size() == parameter.choices.size());
    (void)numbers_of(parameter, text.substr(0, 20));
  }
}

void read_expression(std::string_view text) {
  const auto expression = shader::Expression::parse(text);
  fuzz::require(is_told(expression));
  if (expression) (void)expression->value([](std::string_view) { return std::optional(0.5); });
}

/// No line is lost, as errors of compilers name lines.
void read_program(std::string_view text) {
  const auto glsl = shader::read_glsl(text, {"uv"});
  if (text.find('\r') == text.npos)
    fuzz::require(std::ranges::count(glsl.text, '\n') == std::ranges::count(text, '\n') + 1);
  static fuzz::MemoryFile file;
  file.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  fuzz::require(is_told(shader::read_shadertoy(file.path())));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text = fuzz::text_of({data, size});
  read_chain(text);
  read_isf(text);
  read_expression(text);
  read_program(text);
  return 0;
}
