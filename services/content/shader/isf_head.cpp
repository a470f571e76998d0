// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/isf_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "ipc/base/quote.hpp"
#include "services/content/shader/sloppy_json.hpp"

namespace handcast::content::shader {
namespace {

using Json = nlohmann::json;
using Type = IsfInput::Type;
using Kind = Parameter::Kind;

tl::unexpected<Error> bad_head(std::string sentence) {
  return fail(Errc::bad_config, std::move(sentence));
}

/// The value of a key; null if there is none, whatever the element is.
const Json& at(const Json& element, const char* key) {
  static const Json kNone;
  if (!element.is_object()) return kNone;
  const auto found = element.find(key);
  return found == element.end() ? kNone : *found;
}

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number() ? value.dump() : std::string();
}

/// A number, however it is written: 1, true, "1.5".
std::optional<double> number_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  if (value.is_boolean()) return value.get<bool>() ? 1 : 0;
  if (value.is_string())
    if (const auto expression = Expression::parse(value.get<std::string>());
        expression && expression->names().empty())
      return expression->value({});
  return std::nullopt;
}

bool is_true(const Json& value) { return number_of(value).value_or(0) != 0; }

std::vector<double> numbers_in_json(const Json& value) {
  std::vector<double> numbers;
  if (value.is_array()) {
    for (const auto& element : value)
      if (const auto number = number_of(element)) numbers.push_back(*number);
  } else if (const auto number = number_of(value)) {
    numbers.push_back(*number);
  }
  return numbers;
}

/// The numbers of a key, if they are `count`.
std::vector<double> exactly(const Json& value, std::size_t count) {
  auto numbers = numbers_in_json(value);
  if (count == 4 && numbers.size() == 3) numbers.push_back(1);
  if (numbers.size() != count) numbers.clear();
  return numbers;
}

bool is_identifier(std::string_view name) {
  return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
         std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

constexpr std::array<std::pair<std::string_view, Type>, 11> kTypes{{
    {"event", Type::event},
    {"bool", Type::flag},
    {"long", Type::whole},
    {"int", Type::whole},
    {"float", Type::number},
    {"point2d", Type::point},
    {"color", Type::colour},
    {"image", Type::image},
    {"audio", Type::audio},
    {"audiofft", Type::audio_fft},
    {"cube", Type::image},
}};

Kind kind_of(Type type) {
  constexpr std::array kKinds{Kind::event,  Kind::flag,    Kind::whole, Kind::number, Kind::point,
                              Kind::colour, Kind::picture, Kind::sound, Kind::sound};
  return kKinds[static_cast<std::size_t>(type)];
}

/// A list to choose from: VALUES, LABELS, or both.
void read_choices(const Json& element, Parameter& parameter) {
  parameter.values = numbers_in_json(at(element, "VALUES"));
  if (const Json& labels = at(element, "LABELS"); labels.is_array())
    for (const auto& label : labels) parameter.choices.push_back(text_of(label));
  while (parameter.values.size() < parameter.choices.size() && at(element, "VALUES").is_null())
    parameter.values.push_back(static_cast<double>(parameter.values.size()));
  if (parameter.values.empty()) return;
  parameter.kind = Kind::choice;
  for (std::size_t i = parameter.choices.size(); i < parameter.values.size(); ++i)
    parameter.choices.push_back(fmt::format("{:g}", parameter.values[i]));
  parameter.choices.resize(parameter.values.size());
}

void read_range(const Json& element, IsfInput& input) {
  Parameter& parameter = input.parameter;
  const std::size_t count = input.type == Type::point ? 2 : input.type == Type::colour ? 4 : 1;
  parameter.least = exactly(at(element, "MIN"), count);
  parameter.most = exactly(at(element, "MAX"), count);
  parameter.initial = exactly(at(element, "DEFAULT"), count);
  if (input.type == Type::number && parameter.least.empty() && parameter.most.empty()) {
    parameter.least = {std::min(0., parameter.initial.empty() ? 0 : parameter.initial[0])};
    parameter.most = {std::max(1., parameter.initial.empty() ? 1 : parameter.initial[0])};
  }
  if (input.type == Type::point && (parameter.least.empty() || parameter.most.empty())) {
    input.is_in_pixels = true;
    if (parameter.initial.empty()) parameter.initial = {0.5, 0.5};
  }
  if (!parameter.initial.empty()) return;
  parameter.initial.assign(count, 0);
  if (input.type == Type::colour) parameter.initial = {1, 1, 1, 1};
  if (parameter.kind == Kind::choice) parameter.initial = {parameter.values[0]};
  for (std::size_t i = 0; i < count && input.type == Type::number; ++i)
    if (!parameter.least.empty() && !parameter.most.empty())
      parameter.initial[i] = std::clamp(0., std::min(parameter.least[i], parameter.most[i]),
                                        std::max(parameter.least[i], parameter.most[i]));
}

Result<IsfInput> read_input_of(const Json& element) {
  IsfInput input;
  input.parameter.name = text_of(at(element, "NAME"));
  if (!is_identifier(input.name()))
    return bad_head(
        fmt::format("an input has the name {}; it must be one of GLSL", quote(input.name())));
  std::string type = text_of(at(element, "TYPE"));
  std::ranges::transform(type, type.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto found = std::ranges::find(kTypes, type, &std::pair<std::string_view, Type>::first);
  if (found == kTypes.end())
    return bad_head(
        fmt::format("the input {} has the type {}; types are event, bool, long, "
                    "float, point2D, color, image, audio and audioFFT",
                    input.name(), quote(type)));
  input.type = found->second;
  input.parameter.kind = kind_of(input.type);
  input.parameter.label = text_of(at(element, "LABEL"));
  if (input.parameter.label.empty()) input.parameter.label = input.name();
  if (input.type == Type::whole) read_choices(element, input.parameter);
  if (!input.is_image()) read_range(element, input);
  if (input.type >= Type::audio)
    input.most_samples =
        static_cast<int>(std::clamp(number_of(at(element, "MAX")).value_or(0), 0., 4096.));
  return input;
}

Result<std::optional<Expression>> read_size(const Json& value, std::string_view which,
                                            const IsfHead& head) {
  if (value.is_null() || (value.is_string() && value.get<std::string>().empty()))
    return std::optional<Expression>();
  if (value.is_number()) return std::optional(Expression(value.get<double>()));
  auto expression = Expression::parse(text_of(value));
  if (!expression)
    return bad_head(fmt::format("the {} of a pass, {}, {}", which, quote(text_of(value)),
                                expression.error().what));
  for (const auto& name : expression->names())
    if (name != "WIDTH" && name != "HEIGHT" && !head.input(name))
      return bad_head(fmt::format("the {} of a pass, {}, needs an input {} that there is not",
                                  which, quote(text_of(value)), quote(name)));
  return std::optional(std::move(*expression));
}

Result<IsfPass> read_pass(const Json& element, const IsfHead& head) {
  IsfPass pass;
  pass.target = text_of(at(element, "TARGET"));
  if (!pass.target.empty() && !is_identifier(pass.target))
    return bad_head(
        fmt::format("a pass has the TARGET {}; it must be a name of GLSL", quote(pass.target)));
  auto width = read_size(at(element, "WIDTH"), "WIDTH", head);
  if (!width) return tl::make_unexpected(width.error());
  auto height = read_size(at(element, "HEIGHT"), "HEIGHT", head);
  if (!height) return tl::make_unexpected(height.error());
  pass.width = std::move(*width);
  pass.height = std::move(*height);
  pass.is_persistent = is_true(at(element, "PERSISTENT"));
  pass.is_float = is_true(at(element, "FLOAT"));
  pass.is_drawn_once = !pass.target.empty() && is_true(at(element, "ONCE"));
  return pass;
}

/// A list of elements with a NAME, or a dictionary of them by name: each element with its name.
std::vector<Json> named_elements(const Json& value) {
  std::vector<Json> elements;
  if (value.is_array())
    for (const auto& element : value)
      elements.push_back(element.is_string() ? Json{{"NAME", element}} : element);
  if (value.is_object())
    for (const auto& [name, element] : value.items()) {
      elements.push_back(element.is_object() ? element : Json{{"PATH", element}});
      elements.back()["NAME"] = name;
    }
  return elements;
}

/// The buffers of ISF 1: PERSISTENT_BUFFERS, which passes of the same name draw.
Result<void> read_buffers(const Json& json, IsfHead& head) {
  for (Json element : named_elements(at(json, "PERSISTENT_BUFFERS"))) {
    element["TARGET"] = at(element, "NAME");
    element["PERSISTENT"] = true;
    auto buffer = read_pass(element, head);
    if (!buffer) return tl::make_unexpected(buffer.error());
    bool is_drawn = false;
    for (IsfPass& pass : head.passes) {
      if (pass.target != buffer->target) continue;
      is_drawn = true;
      pass.is_persistent = true;
      pass.is_float |= buffer->is_float;
      if (!pass.width) pass.width = buffer->width;
      if (!pass.height) pass.height = buffer->height;
    }
    if (!is_drawn) head.buffers.push_back(std::move(*buffer));
  }
  return {};
}

Result<IsfHead> read_head(const Json& json) {
  IsfHead head;
  head.description = text_of(at(json, "DESCRIPTION"));
  for (const Json& element : named_elements(at(json, "INPUTS"))) {
    auto input = read_input_of(element);
    if (!input) return tl::make_unexpected(input.error());
    if (!head.input(input->name())) head.inputs.push_back(std::move(*input));
  }
  const Json& passes = at(json, "PASSES");
  for (const Json& element : passes.is_array() ? passes : Json::array({passes})) {
    auto pass = read_pass(element, head);
    if (!pass) return tl::make_unexpected(pass.error());
    head.passes.push_back(std::move(*pass));
  }
  if (head.passes.empty()) head.passes.emplace_back();
  if (auto read = read_buffers(json, head); !read) return tl::make_unexpected(read.error());
  for (const Json& element : named_elements(at(json, "IMPORTED"))) {
    const Json& path = at(element, "PATH");
    head.imports.push_back(
        {text_of(at(element, "NAME")), text_of(path.is_array() && !path.empty() ? path[0] : path)});
    if (!is_identifier(head.imports.back().name)) head.imports.pop_back();
  }
  return head;
}

/// The first comment with a brace.
Result<std::string_view> json_part(std::string_view text) {
  for (auto begin = text.find("/*"); begin != text.npos; begin = text.find("/*", begin)) {
    const auto brace = text.find_first_not_of(" \t\r\n*", begin + 2),
               end = text.find("*/", begin + 2);
    const bool is_head = brace != text.npos && text[brace] == '{';
    if (is_head && end == text.npos) return bad_head("the comment at its beginning has no end, */");
    if (is_head) return text.substr(brace, text.rfind('}', end) + 1 - brace);
    if (end == text.npos) break;
    begin = end + 2;
  }
  return bad_head("it is no ISF file: it has no comment in JSON, /*{ ... }*/, at its beginning");
}

}  // namespace

const IsfInput* IsfHead::input(std::string_view name) const {
  const auto found = std::ranges::find(inputs, name, &IsfInput::name);
  return found == inputs.end() ? nullptr : &*found;
}

Result<IsfHead> parse_isf_head(std::string_view text) {
  const auto part = json_part(text);
  if (!part) return tl::make_unexpected(part.error());
  const auto first_line = 1 + std::count(text.begin(), part->begin(), '\n');
  const auto strict = strict_json(*part);
  try {
    return read_head(Json::parse(strict));
  } catch (const Json::parse_error& error) {
    const auto end =
        strict.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, strict.size()));
    return bad_head(fmt::format("line {}: the head is no JSON; check its commas and quotes there",
                                first_line + std::count(strict.begin(), end, '\n')));
  } catch (const Json::exception&) {
    return bad_head("the head is no ISF; check the kinds of its values");
  }
}

}  // namespace handcast::content::shader
