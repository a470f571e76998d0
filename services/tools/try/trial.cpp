// SPDX-License-Identifier: Apache-2.0
#include "services/tools/try/trial.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "ipc/base/clock.hpp"
#include "ipc/base/statistics.hpp"
#include "renderer/media/picture.hpp"
#include "services/content/chain.hpp"
#include "services/tools/try/hands.hpp"
#include "services/tools/try/projected.hpp"

namespace handcast::trial {
namespace {

using content::Parameter;
using Kind = Parameter::Kind;
using Views = std::span<const renderer::View<const std::uint32_t>>;

constexpr double kRate_hz = 30;

/// What filters get: circles and a grid that move over colours. The two cards differ.
void paint_card(double time_s, int which, renderer::Texture& card) {
  const float t = static_cast<float>(time_s), phase = which == 0 ? 0.f : 2.f;
  for (int y = 0; y < card.height(); ++y)
    for (int x = 0; x < card.width(); ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(card.width()),
                  v = static_cast<float>(y) / static_cast<float>(card.height());
      const float du = u - 0.5f - 0.3f * std::cos(t + phase), dv = v - 0.5f - 0.3f * std::sin(t);
      const bool is_disc = du * du * 2.56f + dv * dv < 0.02f;
      const bool is_line =
          std::fmod(8 * u + 0.3f * t, 1.f) < 0.06f || std::fmod(5 * v, 1.f) < 0.06f;
      std::uint32_t texel = 0xff000000u;
      for (int c = 0; c < 3; ++c) {
        float level = 0.5f + 0.5f * std::cos(6 * u + 3 * v + phase + 2.1f * static_cast<float>(c));
        if (is_line) level *= 0.3f;
        if (is_disc) level = 1;
        texel |= static_cast<std::uint32_t>(255 * level) << (8 * c);
      }
      card.at(x, y) = texel;
    }
}

/// A filter or a transition with test cards below it.
class WithCards final : public content::Source {
 public:
  WithCards(std::unique_ptr<Source> source, const std::array<renderer::Texture, 2>& cards)
      : source_(std::move(source)), cards_(cards) {}
  content::Needs needs() const override { return source_->needs(); }
  Result<bool> draw(const content::Moment& moment, Views, renderer::Texture& out) override {
    const std::array views{cards_[0].view(), cards_[1].view()};
    const auto count = static_cast<std::size_t>(source_->inputs());
    return source_->draw(moment, Views(views).first(count), out);
  }
  std::span<const Parameter> parameters() const override { return source_->parameters(); }
  Result<void> set(std::string_view name, std::string_view value) override {
    return source_->set(name, value);
  }

 private:
  std::unique_ptr<Source> source_;
  const std::array<renderer::Texture, 2>& cards_;
};

std::string_view name_of(Kind kind) {
  constexpr std::array<std::string_view, 10> kNames{"number", "whole",  "flag", "event",   "choice",
                                                    "point",  "colour", "text", "picture", "sound"};
  return kNames[static_cast<std::size_t>(kind)];
}

Report report_of(const Parameter& parameter) {
  return {{"name", parameter.name},          {"label", parameter.label},
          {"kind", name_of(parameter.kind)}, {"least", parameter.least},
          {"most", parameter.most},          {"initial", parameter.initial},
          {"choices", parameter.choices}};
}

std::string text_of(const std::vector<double>& numbers) {
  return fmt::format("{}", fmt::join(numbers, ","));
}

/// The values with which a parameter is tried: its ends.
std::vector<std::string> ends_of(const Parameter& parameter) {
  switch (parameter.kind) {
    case Kind::flag:
      return {"false", "true"};
    case Kind::event:
      return {"true"};
    case Kind::choice:
      if (parameter.values.empty()) return {};
      return {text_of({parameter.values.front()}), text_of({parameter.values.back()})};
    case Kind::text:
    case Kind::picture:
    case Kind::sound:
      return {};
    default:
      break;
  }
  if (!parameter.least.empty() && !parameter.most.empty())
    return {text_of(parameter.least), text_of(parameter.most)};
  if (parameter.kind == Kind::point) return {"0,0", "1,1"};
  if (parameter.kind == Kind::colour) return {"0,0,0,1", "1,1,1,1"};
  return {};
}

/// True for what the chain adds to each source.
bool is_of_chain(std::string_view name) {
  const auto own = name.substr(name.rfind('.') + 1);
  return own == "opacity" || own == "blend";
}

class Trial {
 public:
  Trial(const Wanted& wanted, const std::function<void(const Report&)>& tell)
      : wanted_(wanted),
        tell_(tell),
        report_(blank_report(wanted.source)),
        until_(Deadline::in(std::chrono::nanoseconds(seconds_to_ns(wanted.patience_s)))) {}

  Report run() {
    if (auto opened = open(); !opened) {
      note_error(opened.error());
    } else {
      give_pictures();
      draw_all();
      if (report_["motion"] == "still") try_parameters();
    }
    tell_(report_);
    return report_;
  }

 private:
  Result<void> open();
  void note_error(const Error& error);
  void give_pictures();
  bool await_streams();
  void draw_all();
  Result<bool> draw(int frame);
  void note_picture(int frame, double ms);
  void save(std::string_view which);
  void save(std::string_view which, const renderer::Texture& picture);
  void try_parameters();
  bool is_set(std::string_view name) const;
  bool reacts(const Parameter& parameter, const renderer::Texture& usual);

  const Wanted& wanted_;
  const std::function<void(const Report&)>& tell_;
  Report report_;
  Deadline until_;
  std::string lone_;  ///< how the chain names its only element
  std::optional<MovingHands> hands_;
  content::BothHands both_;  ///< as they are drawn
  std::array<renderer::Texture, 2> cards_;
  bool uses_cards_ = false, wrote_all_ = true;
  bool is_live_ = false;  ///< a part is a video device or the stream of an address
  std::optional<content::Chain> chain_;
  renderer::Texture picture_, first_;
  std::vector<double> ms_;  ///< of the pictures
};

Result<void> Trial::open() {
  const auto resolved = config::resolve_content(wanted_.source, std::filesystem::current_path());
  if (!resolved) return tl::make_unexpected(resolved.error());
  const auto written = config::parse_content(*resolved);
  if (!written) return tl::make_unexpected(written.error());
  is_live_ = std::ranges::any_of(*written, [](const auto& element) {
    return element.kind == "capture" || element.what.find("://") != element.what.npos;
  });
  if (written->size() == 1)
    lone_ = config::print_content({{(*written)[0].kind, (*written)[0].what, {}}}) + ": ";
  auto hands = MovingHands::load();
  if (!hands) return tl::make_unexpected(hands.error());
  hands_.emplace(std::move(*hands));
  content::Opening opening;
  opening.width = wanted_.width_px;
  opening.height = wanted_.height_px;
  opening.meshes = hands_->meshes();
  picture_ = cards_[0] = cards_[1] = renderer::Texture(opening.width, opening.height);
  const auto with_cards = [this, opened = 0](const content::Opening& like) mutable {
    auto source = content::open_source(like);
    const bool is_lowest = opened++ == 0;
    if (!source || (*source)->inputs() == 0 || ((*source)->inputs() == 1 && !is_lowest))
      return source;
    uses_cards_ = true;
    *source = std::make_unique<WithCards>(std::move(*source), cards_);
    return source;
  };
  const auto begin_ns = now_ns();
  auto chain = content::Chain::open(*written, opening, with_cards);
  report_["open_ms"] = ns_to_ms(now_ns() - begin_ns);
  if (!chain) return tl::make_unexpected(chain.error());
  chain_.emplace(std::move(*chain));
  hands_->needs_surface(chain_->needs().surface || wanted_.projects);
  report_["loaded"] = true;
  for (const auto& parameter : chain_->parameters())
    if (!is_of_chain(parameter.name)) report_["parameters"].push_back(report_of(parameter));
  tell_(report_);
  return {};
}

void Trial::note_error(const Error& error) {
  const bool is_lone = !lone_.empty() && error.what.starts_with(lone_);
  report_["error"] = error.what.substr(is_lone ? lone_.size() : 0);
}

/// Gives a test card for each picture that can be set and is not.
void Trial::give_pictures() {
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("handcast-try-{}.png", getpid());
  paint_card(1, 1, cards_[1]);
  for (const auto& parameter : chain_->parameters()) {
    if (parameter.kind != Kind::picture || is_set(parameter.name)) continue;
    if (!renderer::write_png(file, std::as_const(cards_[1]).view())) return;
    if (const auto set = chain_->set(parameter.name, file.string()); !set) note_error(set.error());
  }
  std::error_code absent;
  std::filesystem::remove(file, absent);
}

/// True if a parameter is part of what was given.
bool Trial::is_set(std::string_view name) const {
  const auto own = std::string(name.substr(name.rfind('.') + 1));
  return wanted_.source.find(" " + own + "=") != std::string::npos;
}

/// Draws the picture of a frame into picture_ and measures it. Returns whether it is new.
Result<bool> Trial::draw(int frame) {
  const double time_s = frame / kRate_hz;
  both_ = hands_->at(time_s);
  for (int which = 0; which < 2 && uses_cards_; ++which)
    paint_card(time_s, which, cards_[static_cast<std::size_t>(which)]);
  content::Moment moment;
  moment.time_s = time_s;
  moment.step_s = 1 / kRate_hz;
  moment.progress = std::min(1., wanted_.frames > 1 ? frame / (wanted_.frames - 1.) : 0.5);
  const std::time_t now = std::time(nullptr);
  localtime_r(&now, &moment.date);
  moment.day_s = moment.date.tm_hour * 3600 + moment.date.tm_min * 60 + moment.date.tm_sec +
                 std::fmod(time_s, 1.);
  moment.hand = &both_[0];
  moment.other = &both_[1];
  const auto begin_ns = now_ns();
  const auto drew = chain_->draw(moment, picture_);
  if (drew && *drew) note_picture(frame, ns_to_ms(now_ns() - begin_ns));
  return drew;
}

void Trial::note_picture(int frame, double ms) {
  const auto& pixels = picture_.pixels();
  const bool is_first = report_["pictures"] == 0;
  if (is_first) first_ = picture_;
  if (frame < wanted_.frames) {
    report_["pictures"] = report_["pictures"].get<int>() + 1;
    ms_.push_back(ms);
    if (is_first || pixels != first_.pixels()) report_["motion"] = is_first ? "still" : "moves";
  }
  if (std::ranges::any_of(pixels, [&](auto pixel) { return pixel != pixels[0]; }))
    report_["plain"] = false;
}

/// Draws until the streams have brought a picture. Until then, the chain draws an empty one.
bool Trial::await_streams() {
  const auto begin_ns = now_ns();
  int drawn = 0;
  while (!until_.passed()) {
    const auto drew = draw(wanted_.frames);
    if (!drew) return note_error(drew.error()), false;
    drawn += *drew ? 1 : 0;
    if (drawn > 1 || report_["plain"] == false)
      return note_picture(0, ns_to_ms(now_ns() - begin_ns)), true;
    tell_(report_);
    sleep_until_ns(now_ns() + seconds_to_ns(1 / kRate_hz));
  }
  note_error({Errc::timeout, fmt::format("no picture came within {:g} s", wanted_.patience_s)});
  return false;
}

void Trial::draw_all() {
  if (is_live_ && !await_streams()) return;
  bool goes_on = true;
  for (int frame = 0; frame < wanted_.frames && goes_on && (frame < 1 || !until_.passed());
       ++frame) {
    const auto drew = draw(frame);
    if (!drew) note_error(drew.error());
    goes_on = drew || drew.error().code == Errc::bad_data || drew.error().code == Errc::timeout;
    if (drew && frame == 0) save("first");
    if (drew && frame == wanted_.frames / 2 && frame > 0) save("middle");
    tell_(report_);
    if (is_live_) sleep_until_ns(now_ns() + seconds_to_ns(1 / kRate_hz));
  }
  if (report_["pictures"] > 1) save("last");
  report_["drawn"] = goes_on && wrote_all_ && report_["pictures"] > 0;
  if (ms_.empty()) return;
  report_["first_ms"] = ms_[0];
  if (ms_.size() > 1) ms_.erase(ms_.begin());
  report_["median_ms"] = median(ms_);
  report_["p99_ms"] = quantile(ms_, 0.99);
}

void Trial::save(std::string_view which) {
  if (wanted_.folder.empty()) return;
  save(which, picture_);
  if (wanted_.projects)
    save(fmt::format("{}-projected", which), projected(both_[0], picture_, calib::reference_rig()));
}

void Trial::save(std::string_view which, const renderer::Texture& picture) {
  const auto file = wanted_.folder / fmt::format("{}-{}.png", wanted_.name, which);
  if (const auto written = renderer::write_png(file, picture.view()); written) {
    report_["files"].push_back(file.string());
  } else {
    wrote_all_ = false;
    note_error(written.error());
  }
}

void Trial::try_parameters() {
  const renderer::Texture usual = picture_;
  for (const auto& parameter : chain_->parameters()) {
    if (is_of_chain(parameter.name) || until_.passed()) continue;
    if (reacts(parameter, usual)) report_["reacts_to"].push_back(parameter.name);
    tell_(report_);
  }
  if (!report_["reacts_to"].empty()) report_["motion"] = "reacts";
}

bool Trial::reacts(const Parameter& parameter, const renderer::Texture& usual) {
  bool differs = false;
  for (const auto& end : ends_of(parameter)) {
    if (!chain_->set(parameter.name, end) || !draw(wanted_.frames)) return differs;
    differs |= picture_.pixels() != usual.pixels();
  }
  if (parameter.kind != Kind::event) (void)chain_->set(parameter.name, text_of(parameter.initial));
  return differs;
}

}  // namespace

Report blank_report(const std::string& source) {
  return {{"source", source},
          {"loaded", false},
          {"drawn", false},
          {"pictures", 0},
          {"plain", true},
          {"motion", ""},
          {"open_ms", 0.0},
          {"first_ms", 0.0},
          {"median_ms", 0.0},
          {"p99_ms", 0.0},
          {"error", ""},
          {"end", ""},
          {"files", Report::array()},
          {"reacts_to", Report::array()},
          {"parameters", Report::array()}};
}

Report draw_source(const Wanted& wanted, const std::function<void(const Report&)>& tell) {
  return Trial(wanted, tell).run();
}

}  // namespace handcast::trial
