// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/content/chain.hpp"

namespace handcast::test {

using namespace content;  // NOLINT(google-build-using-namespace)

/// What a source of a test does, and what has been done with it. Shared with the test.
struct Script {
  int inputs = 0;
  std::uint32_t colour = 0xff000000u;  ///< of all its pixels; of a filter, added to its input's
  bool is_still = false;               ///< it draws only when its colour has changed
  std::optional<Error> fault;          ///< of the next pictures
  std::optional<Error> closed;         ///< of opening it
  bool is_stale = false;
  int opened = 0, drawn = 0;
  std::vector<Moment> moments;
  std::map<std::string, std::string> values;
};

class FakeSource final : public Source {
 public:
  explicit FakeSource(Script& script) : script_(script) {
    Parameter speed;
    speed.name = "speed";
    speed.initial = {1};
    Parameter hit;
    hit.name = "hit";
    hit.kind = Parameter::Kind::event;
    parameters_ = {speed, hit};
  }
  int inputs() const override { return script_.inputs; }
  Result<bool> draw(const Moment& moment, std::span<const Pixels> inputs,
                    renderer::Texture& out) override {
    ++script_.drawn;
    script_.moments.push_back(moment);
    if (script_.fault) return tl::make_unexpected(*script_.fault);
    if (script_.is_still && last_ == script_.colour) return false;
    last_ = script_.colour;
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x)
        out.at(x, y) = script_.colour + (script_.inputs > 0 ? inputs[0].at(x, y) : 0);
    return true;
  }
  std::span<const Parameter> parameters() const override { return parameters_; }
  Result<void> set(std::string_view name, std::string_view value) override {
    if (std::ranges::count(parameters_, name, &Parameter::name) == 0)
      return Source::set(name, value);
    script_.values[std::string(name)] = value;
    return {};
  }
  bool is_stale() const override { return script_.is_stale; }

 private:
  Script& script_;
  std::optional<std::uint32_t> last_;
  std::vector<Parameter> parameters_;
};

/// Opens "fake:NAME" by the script of this name.
inline OpenSource opener(std::map<std::string, Script>& scripts) {
  return [&scripts](const Opening& opening) -> Result<std::unique_ptr<Source>> {
    Script& script = scripts[opening.element.what];
    ++script.opened;
    if (script.closed) return tl::make_unexpected(*script.closed);
    script.is_stale = false;
    auto source = std::make_unique<FakeSource>(script);
    for (const auto& [name, value] : opening.element.parameters)
      if (auto set = source->set(name, value); !set) return tl::make_unexpected(set.error());
    return source;
  };
}

inline Opening small_opening() {
  Opening opening;
  opening.width = 5;
  opening.height = 3;
  return opening;
}

inline HandState no_hand() { return {}; }

}  // namespace handcast::test
