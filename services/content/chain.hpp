// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/content/blend.hpp"
#include "services/content/source.hpp"

namespace handcast::content {

/// Opens the sources of a chain: open_source(), or that of a test.
using OpenSource = std::function<Result<std::unique_ptr<Source>>(const Opening&)>;

/// The sources and filters of a content, as one picture. The lowest element draws; a source above
/// it is laid over what is below, a filter is given what is below. Two parameters belong to the
/// chain: `blend` of a source (see Blend), and `opacity` (0..1) of a source or filter; a filter's
/// mixes its picture with what is below. One thread.
class Chain {
 public:
  /// Opens all elements, of the size, side and meshes of `like`. Errors, which name the element:
  /// those of open_source(); bad_config (the chain is empty, an element is a transition).
  static Result<Chain> open(const config::ContentChain& chain, const Opening& like,
                            OpenSource open_source = content::open_source);

  /// Draws into `out`, which has the picture of the last call. Returns false if it is the same.
  /// What a moment counts from the opening is counted per element. An element that fails keeps its
  /// last picture (a filter that never drew lets through what is below); it is opened again if its
  /// files have changed, or every 2 s if it is unavailable or disconnected. Errors: those of
  /// elements, each sentence once; everything else is drawn all the same, and the next call tells
  /// that the picture has changed.
  Result<bool> draw(const Moment& moment, renderer::Texture& out);

  /// What its elements need of each moment.
  Needs needs() const;
  /// What can be set; if there are several elements, with the number of the element (from 1) and a
  /// point before each name: "2.speed".
  std::vector<Parameter> parameters() const;
  /// Sets "2.speed" of the second element, or "speed" of the lowest element that has it. Errors
  /// (bad_config): no such parameter, or not its value.
  Result<void> set(std::string_view name, std::string_view value);

 private:
  struct Element {
    Opening opening;  ///< with the values of now
    std::unique_ptr<Source> source;
    Blend blend = Blend::over;
    double opacity = 1;
    bool is_set = true;                ///< its blend or opacity has changed
    bool is_direct = false;            ///< it draws into `result`, without `picture`
    renderer::Texture picture;         ///< its own, if that is not the result
    renderer::Texture result;          ///< with what is below; of the highest element, the caller's
    double opened_s = 0, drawn_s = 0;  ///< times of its first and last picture
    std::uint64_t calls = 0, drawn = 0;
    std::optional<Errc> fault;  ///< of its last picture
    double retry_s = 0;         ///< when it may be opened again
    std::string told;           ///< the last error that was told
  };

  Chain(Opening like, OpenSource open_source)
      : like_(std::move(like)), open_source_(std::move(open_source)) {}
  Result<void> add(const config::ContentElement& written);
  bool draw_element(std::size_t index, const Moment& moment, bool is_below_new,
                    renderer::Texture& out);
  bool draw_own(Element& element, const Moment& moment, Pixels below, renderer::Texture& own);
  void reopen_if_needed(Element& element, double time_s);
  void note_fault(Element& element, Error error, double time_s);
  static Result<void> set_in(Element& element, std::string_view name, std::string_view value);
  static std::vector<Parameter> parameters_of(const Element& element);

  Opening like_;
  OpenSource open_source_;
  std::vector<Element> elements_;
  renderer::Texture nothing_;       ///< below a filter that is the lowest element
  std::optional<Error> to_tell_;    ///< the next error
  bool owes_change_ = false;        ///< a change that an error has kept from being told
  std::optional<double> looked_s_;  ///< when it was last asked whether files have changed
};

}  // namespace handcast::content
