// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "renderer/media/picture.hpp"
#include "services/content/settable_source.hpp"
#include "services/content/shader/file_times.hpp"
#include "services/content/shader/hand_view.hpp"
#include "services/content/shader/shadertoy_text.hpp"
#include "services/content/sound/sound.hpp"

namespace handcast::content {
namespace {

using namespace shader;
namespace fs = std::filesystem;
using Channel = ShadertoyChannel;
using ShadertoyInputs = std::span<const renderer::View<const std::uint32_t>>;

constexpr std::string_view kShadertoyPrelude = R"(
uniform vec3 iResolution, iChannelResolution[4];
uniform float iTime, iTimeDelta, iFrameRate, iSampleRate, iChannelTime[4];
uniform int iFrame;
uniform vec4 iMouse, iDate;
uniform sampler2D iChannel0, iChannel1, iChannel2, iChannel3;
#define iGlobalTime iTime
#define texture2D texture
#define HW_PERFORMANCE 1
out vec4 hc_result;
float hc_finite(float value) { return abs(value) <= 3.0e38 ? value : 0.0; }
)";

/// Numbers that are not finite come out as 0; the image is opaque.
std::string shadertoy_epilogue(bool is_image) {
  return fmt::format(
      "void main() {{\n  vec4 colour = vec4(0.0, 0.0, 0.0, 1.0);\n"
      "  mainImage(colour, gl_FragCoord.xy);\n"
      "  hc_result = vec4(hc_finite(colour.r), hc_finite(colour.g), hc_finite(colour.b), "
      "{});\n}}\n",
      is_image ? "1.0" : "hc_finite(colour.a)");
}

/// A part, compiled.
struct ShadertoyPass {
  UserProgram program;
  std::array<Channel, kShadertoyChannels> channels;
  int buffer = 0;  ///< that it draws; kShadertoyBuffers: the image
};

/// What a buffer drew last, and what it draws next.
struct ShadertoyBuffer {
  Target last, next;
};

Result<std::vector<ShadertoyPass>> compile_parts(Graphics& graphics, const ShadertoyProgram& text,
                                                 const HandView& hands) {
  std::vector<std::string> samplers{"iChannel0", "iChannel1", "iChannel2", "iChannel3"};
  std::ranges::copy(hands.samplers(), std::back_inserter(samplers));
  std::vector<ShadertoyPass> passes;
  for (const auto* part : text.parts()) {
    const bool is_image = part == &text.image;
    const UserStage stage{*part, std::string(kShadertoyPrelude) + hands.declarations(),
                          shadertoy_epilogue(is_image), text.common};
    auto program = UserProgram::make(graphics, stage, plain_vertex_stage(), samplers);
    if (!program) return tl::make_unexpected(program.error());
    int buffer = kShadertoyBuffers;
    for (int i = 0; i < kShadertoyBuffers && !is_image; ++i)
      if (const auto& each = text.buffers[static_cast<std::size_t>(i)]; each && &*each == part)
        buffer = i;
    passes.push_back({std::move(*program), part->channels, buffer});
  }
  return passes;
}

/// True if the pictures depend on nothing but its parameter.
bool is_still_program(const ShadertoyProgram& text, const HandView& hands) {
  const auto words = text.words();
  for (const auto* word : {"iTime", "iGlobalTime", "iTimeDelta", "iFrame", "iDate", "iChannelTime"})
    if (words.contains(word)) return false;
  return text.parts().size() == 1 && !text.reads(Channel::From::input) &&
         !text.reads(Channel::From::sound) && !hands.is_live();
}

class ShadertoySource final : public SettableSource {
 public:
  ShadertoySource(std::shared_ptr<Graphics> graphics, const ShadertoyProgram& text,
                  std::unique_ptr<HandView> hands, std::vector<ShadertoyPass> passes,
                  const Opening& opening)
      : SettableSource({mouse_parameter()}),
        graphics_(std::move(graphics)),
        hands_(std::move(hands)),
        passes_(std::move(passes)),
        width_(opening.width),
        height_(opening.height),
        is_filter_(text.reads(Channel::From::input)),
        hears_(text.reads(Channel::From::sound)),
        is_still_(is_still_program(text, *hands_)),
        files_(text.files),
        sound_device_(opening.sound) {
    output_ = graphics_->make_target(GL_RGBA8, width_, height_);
    for (std::size_t i = 0; i < buffers_.size(); ++i)
      if (text.buffers[i])
        for (Target* const target : {&buffers_[i].last, &buffers_[i].next})
          *target = graphics_->make_target(GL_RGBA32F, width_, height_);
  }

  /// Errors (bad_config): those of read_premultiplied_picture().
  Result<void> load_pictures() {
    for (const auto& pass : passes_)
      for (const auto& channel : pass.channels) {
        if (channel.from != Channel::From::picture || pictures_.contains(channel.picture)) continue;
        const auto picture = renderer::read_premultiplied_picture(channel.picture);
        if (!picture) return tl::make_unexpected(picture.error());
        graphics_->upload(pictures_[channel.picture], picture->view(), true);
      }
    return {};
  }

  int inputs() const override { return is_filter_ ? 1 : 0; }
  Needs needs() const override { return hands_->needs(); }
  bool is_stale() const override { return files_.have_changed(); }

  Result<void> set(std::string_view name, std::string_view value) override {
    auto set = SettableSource::set(name, value);
    has_mouse_ |= set.has_value();
    return set;
  }

  Result<bool> draw(const Moment& moment, ShadertoyInputs inputs, renderer::Texture& out) override {
    const bool is_changed = take_change();
    if (is_still_ && !is_changed) return false;
    if (auto usable = graphics_->use(); !usable) return tl::make_unexpected(usable.error());
    if (!inputs.empty()) graphics_->upload(input_, inputs[0], true);
    if (hears_) hear();
    hands_->update(*graphics_, moment);
    for (const auto& pass : passes_) draw_pass(pass, moment);
    graphics_->read(output_, out);
    if (auto good = graphics_->check(); !good) return tl::make_unexpected(good.error());
    return true;
  }

 private:
  static Parameter mouse_parameter() {
    auto mouse = plain_parameter("mouse", "Where the mouse is held down, in parts of the picture",
                                 Parameter::Kind::point, {0, 0});
    mouse.least = {0, 0};
    mouse.most = {1, 1};
    return mouse;
  }

  /// Fills the image of sound. Only a shader that is drawn needs the device.
  void hear() {
    if (!listener_) listener_.emplace(sound_device_);
    const auto image = spectrum_.shadertoy_image_of(listener_->newest());
    graphics_->upload_levels(sound_, image.width, image.height, image.levels);
  }

  const Texels& texels_of(const Channel& channel) {
    const Texels* texels = nullptr;
    if (channel.from == Channel::From::buffer)
      texels = &buffers_[static_cast<std::size_t>(channel.buffer)].last.texels;
    if (channel.from == Channel::From::input) texels = &input_;
    if (channel.from == Channel::From::sound) texels = &sound_;
    if (channel.from == Channel::From::picture) texels = &pictures_[channel.picture];
    return texels && texels->width > 0 ? *texels : graphics_->nothing();
  }

  void bind(GLuint unit, const Channel& channel, const UserProgram& program) {
    const auto& gl = graphics_->functions();
    const Texels& texels = texels_of(channel);
    const auto name = texels.image.name();
    const GLint filter = channel.is_nearest ? GL_NEAREST : GL_LINEAR;
    constexpr std::array<GLint, 3> kWraps{GL_CLAMP_TO_EDGE, GL_REPEAT, GL_MIRRORED_REPEAT};
    const GLint wrap = kWraps[static_cast<std::size_t>(channel.wrap)];
    gl.TextureParameteri(name, GL_TEXTURE_MIN_FILTER, filter);
    gl.TextureParameteri(name, GL_TEXTURE_MAG_FILTER, filter);
    gl.TextureParameteri(name, GL_TEXTURE_WRAP_S, wrap);
    gl.TextureParameteri(name, GL_TEXTURE_WRAP_T, wrap);
    gl.BindTextureUnit(unit, name);
    program.set(fmt::format("iChannelResolution[{}]", unit),
                glm::vec3(texels.width, texels.height, 1));
  }

  void set_uniforms(const UserProgram& program, const Moment& moment) const {
    const glm::vec2 size(width_, height_);
    program.set("iResolution", glm::vec3(size, 1));
    program.set("iTime", static_cast<float>(moment.time_s));
    program.set("iTimeDelta", static_cast<float>(moment.step_s));
    program.set("iFrameRate", static_cast<float>(1 / std::max(moment.step_s, 1e-3)));
    program.set("iFrame", static_cast<int>(moment.frame & 0x7fffffff));
    program.set("iSampleRate", static_cast<float>(kHeardRate_hz));
    const std::tm& date = moment.date;
    program.set("iDate", glm::vec4(date.tm_year + 1900, date.tm_mon, date.tm_mday,
                                   static_cast<float>(moment.day_s)));
    for (int i = 0; i < kShadertoyChannels; ++i)
      program.set(fmt::format("iChannelTime[{}]", i), static_cast<float>(moment.time_s));
    const auto mouse = numbers("mouse");
    const glm::vec2 at = glm::vec2(mouse[0], mouse[1]) * size;
    program.set("iMouse", has_mouse_ ? glm::vec4(at, at.x, -at.y) : glm::vec4(0));
    hands_->set(program, moment);
  }

  void draw_pass(const ShadertoyPass& pass, const Moment& moment) {
    set_uniforms(pass.program, moment);
    GLuint unit = 0;
    for (const auto& channel : pass.channels) bind(unit++, channel, pass.program);
    for (const auto* map : hands_->images())
      graphics_->functions().BindTextureUnit(unit++, map->image.name());
    graphics_->functions().UseProgram(pass.program.name());
    if (pass.buffer == kShadertoyBuffers) return graphics_->draw(output_, true);
    auto& buffer = buffers_[static_cast<std::size_t>(pass.buffer)];
    graphics_->draw(buffer.next, true);
    std::swap(buffer.last, buffer.next);
  }

  std::shared_ptr<Graphics> graphics_;  // first: the objects below are of it
  std::unique_ptr<HandView> hands_;
  std::vector<ShadertoyPass> passes_;
  int width_, height_;
  bool is_filter_, hears_, is_still_, has_mouse_ = false;
  FileTimes files_;
  Target output_;
  std::array<ShadertoyBuffer, kShadertoyBuffers> buffers_;
  std::map<fs::path, Texels> pictures_;
  Texels input_, sound_;
  std::string sound_device_;
  std::optional<SoundListener> listener_;
  Spectrum spectrum_;
};

}  // namespace

Result<std::unique_ptr<Source>> open_shadertoy(const Opening& opening) {
  auto graphics = Graphics::open();
  if (!graphics) return tl::make_unexpected(graphics.error());
  if (auto usable = (*graphics)->use(); !usable) return tl::make_unexpected(usable.error());
  const auto text = read_shadertoy(opening.element.what);
  if (!text) return tl::make_unexpected(text.error());
  auto hands = std::make_unique<HandView>(text->words(), opening);
  auto passes = compile_parts(**graphics, *text, *hands);
  if (!passes) return tl::make_unexpected(passes.error());
  auto source = std::make_unique<ShadertoySource>(std::move(*graphics), *text, std::move(hands),
                                                  std::move(*passes), opening);
  if (auto loaded = source->load_pictures(); !loaded) return tl::make_unexpected(loaded.error());
  return source;
}

}  // namespace handcast::content
