// SPDX-License-Identifier: Apache-2.0
#include "services/content/chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "services/content/settable_source.hpp"

namespace handcast::content {
namespace {

constexpr double kRetry_s = 2, kLook_s = 0.5;

const Parameter& opacity_parameter() {
  static const Parameter kOpacity = number_parameter("opacity", "Opacity", 0, 1, 1);
  return kOpacity;
}

const Parameter& blend_parameter() {
  static const Parameter kBlend = choice_parameter("blend", "How it is laid over what is below",
                                                   {blend_names().begin(), blend_names().end()});
  return kBlend;
}

bool is_of_chain(std::string_view name) { return name == "blend" || name == "opacity"; }

std::string name_of(const config::ContentElement& element) {
  return element.kind + ":" + element.what;
}

/// The error with the name of its element, unless its sentence has it: that of a file begins with
/// its name, others quote it.
Error named(const config::ContentElement& element, Error error) {
  const auto& what = element.what;
  const auto name = std::filesystem::path(what).filename().string();
  const bool has_it =
      !what.empty() && (error.what.starts_with(what + ":") || error.what.starts_with(name + ":") ||
                        error.what.find(quote(what)) != std::string::npos);
  if (!has_it) error.what = config::print_content({element}) + ": " + error.what;
  return error;
}

/// "2.speed" as 2 and "speed"; 0 without a number.
std::pair<std::size_t, std::string_view> split_number(std::string_view name) {
  std::size_t number = 0;
  const auto point = name.find('.');
  if (point == name.npos) return {0, name};
  const auto [end, error] = std::from_chars(name.data(), name.data() + point, number);
  if (error != std::errc() || end != name.data() + point) return {0, name};
  return {number, name.substr(point + 1)};
}

}  // namespace

Result<Chain> Chain::open(const config::ContentChain& chain, const Opening& like,
                          OpenSource open_source) {
  Chain opened(like, std::move(open_source));
  if (chain.empty()) return fail(Errc::bad_config, "content is empty; name a source");
  opened.elements_.reserve(chain.size());
  for (const auto& written : chain)
    if (auto added = opened.add(written); !added) return tl::make_unexpected(added.error());
  return opened;
}

Result<void> Chain::add(const config::ContentElement& written) {
  Element& element = elements_.emplace_back();
  element.opening = like_;
  element.opening.element = written;
  std::erase_if(element.opening.element.parameters,
                [](const auto& parameter) { return is_of_chain(parameter.first); });
  config::ContentElement plain = written;
  plain.parameters.clear();
  auto source = open_source_(element.opening);
  if (!source) return tl::make_unexpected(named(plain, source.error()));
  element.source = std::move(*source);
  if (element.source->inputs() > 1)
    return fail(Errc::bad_config,
                fmt::format("{} is a transition, which needs two pictures; it can be used to "
                            "change content, but not in a chain",
                            name_of(written)));
  for (const auto& [name, value] : written.parameters)
    if (is_of_chain(name))
      if (auto set = set_in(element, name, value); !set)
        return tl::make_unexpected(named(plain, set.error()));
  element.result = renderer::Texture(like_.width, like_.height);
  if (elements_.size() == 1) nothing_ = element.result;
  return {};
}

Result<bool> Chain::draw(const Moment& moment, renderer::Texture& out) {
  if (!looked_s_ || moment.time_s - *looked_s_ >= kLook_s) {
    looked_s_ = moment.time_s;
    for (Element& element : elements_) reopen_if_needed(element, moment.time_s);
  }
  if (out.width() != like_.width || out.height() != like_.height)
    out = renderer::Texture(like_.width, like_.height);
  bool is_new = false;
  for (std::size_t i = 0; i < elements_.size(); ++i)
    is_new = draw_element(i, moment, is_new, i + 1 == elements_.size() ? out : elements_[i].result);
  owes_change_ = owes_change_ || is_new;
  if (to_tell_) return tl::make_unexpected(*std::exchange(to_tell_, std::nullopt));
  return std::exchange(owes_change_, false);
}

/// Draws an element and lays it over what is below. Returns whether the result is new.
bool Chain::draw_element(std::size_t index, const Moment& moment, bool is_below_new,
                         renderer::Texture& out) {
  Element& element = elements_[index];
  const bool is_filter = element.source->inputs() == 1;
  const Pixels below = (index == 0 ? nothing_ : elements_[index - 1].result).view();
  const bool is_direct = element.opacity == 1 && (is_filter ? element.drawn > 0 : index == 0);
  if (is_direct && !element.is_direct && element.picture.width() > 0) out = element.picture;
  if (!is_direct && (element.is_direct || element.picture.width() == 0)) element.picture = out;
  element.is_direct = is_direct;
  const bool is_own_new = draw_own(element, moment, below, is_direct ? out : element.picture);
  const bool is_new = is_own_new || is_below_new || element.is_set;
  if (is_direct) return std::exchange(element.is_set, false) || is_own_new;
  element.is_set = false;
  if (!is_new) return false;
  const Pixels own = std::as_const(element.picture).view();
  if (is_filter)
    mix(below, own, element.drawn > 0 ? element.opacity : 0, out);
  else
    blend(below, own, element.blend, element.opacity, out);
  return true;
}

bool Chain::draw_own(Element& element, const Moment& moment, Pixels below, renderer::Texture& own) {
  if (element.fault && *element.fault != Errc::bad_data && *element.fault != Errc::timeout)
    return false;
  if (element.calls++ == 0) element.opened_s = moment.time_s;
  Moment its = moment;
  its.time_s = moment.time_s - element.opened_s;
  if (element.drawn > 0) its.step_s = moment.time_s - element.drawn_s;
  its.frame = element.drawn;
  const std::size_t inputs = element.source->inputs() == 1 ? 1 : 0;
  const auto drew = element.source->draw(its, {&below, inputs}, own);
  if (!drew) {
    note_fault(element, drew.error(), moment.time_s);
    return false;
  }
  if (element.fault != Errc::bad_data) element.told.clear();
  element.fault.reset();
  if (*drew) {
    element.drawn_s = moment.time_s;
    ++element.drawn;
  }
  return *drew;
}

void Chain::reopen_if_needed(Element& element, double time_s) {
  const bool is_gone = element.fault == Errc::unavailable || element.fault == Errc::disconnected;
  if (time_s < element.retry_s || !(is_gone || element.source->is_stale())) return;
  auto source = open_source_(element.opening);
  if (source && (*source)->inputs() > 1)
    source = fail(Errc::bad_config, "it has become a transition, which is not used in a chain");
  if (!source) {
    const auto fault = element.fault;  // the old one goes on
    note_fault(element, source.error(), time_s);
    element.fault = fault;
    return;
  }
  element.source = std::move(*source);
  element.fault.reset();
  element.calls = element.drawn = 0;
}

void Chain::note_fault(Element& element, Error error, double time_s) {
  element.fault = error.code;
  element.retry_s = time_s + kRetry_s;
  if (element.told == error.what) return;
  element.told = error.what;
  auto plain = element.opening.element;
  plain.parameters.clear();
  to_tell_ = named(plain, std::move(error));
}

std::vector<Parameter> Chain::parameters_of(const Element& element) {
  const auto own = element.source->parameters();
  std::vector<Parameter> all(own.begin(), own.end());
  std::erase_if(all, [](const Parameter& parameter) { return is_of_chain(parameter.name); });
  if (element.source->inputs() == 0) all.push_back(blend_parameter());
  all.push_back(opacity_parameter());
  return all;
}

std::vector<Parameter> Chain::parameters() const {
  std::vector<Parameter> all;
  for (std::size_t i = 0; i < elements_.size(); ++i)
    for (Parameter& parameter : parameters_of(elements_[i])) {
      if (elements_.size() > 1) parameter.name = fmt::format("{}.{}", i + 1, parameter.name);
      all.push_back(std::move(parameter));
    }
  return all;
}

Result<void> Chain::set(std::string_view name, std::string_view value) {
  const auto [number, plain] = split_number(name);
  if (number > elements_.size() || (number == 0 && plain != name))
    return fail(Errc::bad_config,
                fmt::format("there is no {} to set; the content has {} elements, from 1",
                            quote(name), elements_.size()));
  if (number > 0) return set_in(elements_[number - 1], plain, value);
  for (Element& element : elements_)
    if (std::ranges::count(parameters_of(element), plain, &Parameter::name) > 0)
      return set_in(element, plain, value);
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters()) names.push_back(parameter.name);
  return fail(Errc::bad_config,
              fmt::format("there is no {} to set; there are: {}", quote(name), join(names, ", ")));
}

Result<void> Chain::set_in(Element& element, std::string_view name, std::string_view value) {
  if (is_of_chain(name)) {
    const bool is_blend = name == "blend";
    if (is_blend && element.source->inputs() > 0)
      return fail(Errc::bad_config,
                  "a filter has no blend; opacity mixes its picture with what is below");
    const auto numbers =
        numbers_in_range(is_blend ? blend_parameter() : opacity_parameter(), value);
    if (!numbers) return tl::make_unexpected(numbers.error());
    if (is_blend)
      element.blend = static_cast<Blend>((*numbers)[0]);
    else
      element.opacity = (*numbers)[0];
    element.is_set = true;
    return {};
  }
  if (auto set = element.source->set(name, value); !set) return set;
  if (element.fault == Errc::bad_config) element.fault.reset();
  const auto own = element.source->parameters();
  const auto found = std::ranges::find(own, name, &Parameter::name);
  if (found != own.end() && found->kind == Parameter::Kind::event) return {};
  auto& values = element.opening.element.parameters;
  std::erase_if(values, [name](const auto& parameter) { return parameter.first == name; });
  values.emplace_back(name, value);
  return {};
}

Needs Chain::needs() const {
  Needs all;
  for (const auto& element : elements_) all |= element.source->needs();
  return all;
}

}  // namespace handcast::content
