// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "services/content/source.hpp"

namespace handcast::content {

Result<std::unique_ptr<Source>> open_isf(const Opening&);
Result<std::unique_ptr<Source>> open_look(const Opening&);
Result<std::unique_ptr<Source>> open_film(const Opening&);
Result<std::unique_ptr<Source>> open_capture(const Opening&);
Result<std::unique_ptr<Source>> open_text(const Opening&);
Result<std::unique_ptr<Source>> open_clock(const Opening&);
Result<std::unique_ptr<Source>> open_pattern(const Opening&);
Result<std::unique_ptr<Source>> open_picture(const Opening&);
Result<std::unique_ptr<Source>> open_paint(const Opening&);
Result<std::unique_ptr<Source>> open_hand(const Opening&);
Result<std::unique_ptr<Source>> open_shadertoy(const Opening&);
Result<std::unique_ptr<Source>> open_skeleton(const Opening&);
Result<std::unique_ptr<Source>> open_program(const Opening&);
Result<std::unique_ptr<Source>> open_projegraphy(const Opening&);
Result<std::unique_ptr<Source>> open_view(const Opening&);

static constexpr SourceKind kKinds[] = {
    {"look", "One of handcast's own looks, by its name.", open_look},
    {"picture", "A PNG or JPEG file.", open_picture},
    {"film", "A film, or a stream by its address.", open_film},
    {"capture", "A video device: a camera, or another program by v4l2loopback.", open_capture},
#ifdef HANDCAST_WITH_PANGO
    {"text", "Text in any script.", open_text},
    {"clock", "The time, e.g. clock:%H:%M.", open_clock},
#endif
    {"pattern",
     "A pattern of the hand: atlas, checker, skeleton, white, seams, joints, bones, bars.",
     open_pattern},
    {"isf", "A shader in the Interactive Shader Format, version 2.", open_isf},
    {"paint", "Drawn on this hand by the index finger of the other one.", open_paint},
    {"hand", "What the camera sees of the hand.", open_hand},
    {"shadertoy", "A shader by the conventions of Shadertoy.", open_shadertoy},
    {"skeleton", "The bones under the skin, in colours that show their speed.", open_skeleton},
    {"projegraphy", "The animal that the hands look like, painted on them.", open_projegraphy},
    {"view", "A picture as the projector sees it, or what is below, put onto the hand.", open_view},
    {"program", "The pictures of any other program, by handcast.h.", open_program},
};

std::span<const SourceKind> source_kinds() { return kKinds; }

Result<std::unique_ptr<Source>> open_source(const Opening& opening) {
  const auto found = std::ranges::find(kKinds, opening.element.kind, &SourceKind::name);
  if (found == std::end(kKinds)) {
    std::vector<std::string_view> names;
    for (const auto& kind : kKinds) names.push_back(kind.name);
    return fail(Errc::bad_config, fmt::format("there is no kind of content {}; there are: {}",
                                              quote(opening.element.kind), join(names, ", ")));
  }
  auto source = found->open(opening);
  if (!source) return source;
  for (const auto& [name, value] : opening.element.parameters)
    if (auto set = (*source)->set(name, value); !set)
      return fail_in(opening.element.what.empty() ? opening.element.kind : opening.element.what,
                     set.error());
  return source;
}

}  // namespace handcast::content
