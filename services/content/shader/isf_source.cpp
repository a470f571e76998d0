// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "ipc/base/log.hpp"
#include "renderer/media/picture.hpp"
#include "services/content/scaled.hpp"
#include "services/content/settable_source.hpp"
#include "services/content/shader/file_times.hpp"
#include "services/content/shader/isf_program.hpp"
#include "services/content/sound/sound.hpp"

namespace handcast::content {
namespace {

using namespace shader;
namespace fs = std::filesystem;
using Type = IsfInput::Type;
using Views = std::span<const renderer::View<const std::uint32_t>>;

constexpr std::string_view kInput = "inputImage", kStart = "startImage", kEnd = "endImage",
                           kProgress = "progress";

/// The image of a pass: what it drew last, and, if it persists, a second one to draw into.
struct Buffer {
  Target last, next;
};

/// The samples in an image of sound that states no number of them.
constexpr int kWaveform = 1024;

struct Ears {
  SoundListener listener;
  Spectrum spectrum;
  explicit Ears(const std::string& device) : listener(device) {}
};

/// The names that are not set by a person: images that the chain gives, and the time of a
/// transition.
bool is_given(const IsfHead& head, std::string_view name) {
  const bool is_transition = head.input(kStart) && head.input(kEnd);
  return name == kInput || (is_transition && (name == kStart || name == kEnd || name == kProgress));
}

std::vector<Parameter> parameters_of(const IsfHead& head) {
  std::vector<Parameter> parameters;
  for (const auto& input : head.inputs) {
    if (is_given(head, input.name()) || input.type >= Type::audio) continue;
    parameters.push_back(input.parameter);
  }
  return parameters;
}

class IsfSource final : public SettableSource {
 public:
  IsfSource(std::shared_ptr<Graphics> graphics, IsfProgram isf, const Opening& opening)
      : SettableSource(parameters_of(isf.head)),
        graphics_(std::move(graphics)),
        isf_(std::move(isf)),
        width_(opening.width),
        height_(opening.height),
        files_(isf_.files),
        sound_device_(opening.sound) {
    output_ = graphics_->make_target(GL_RGBA8, width_, height_);
  }

  /// An image that cannot be read is transparent black, and a warning.
  void load_imports(const fs::path& folder) {
    for (const auto& import : isf_.head.imports)
      if (const auto loaded = load(import.name, folder / import.path); !loaded)
        log::warning("{}: {}", isf_.files.front().filename().string(), loaded.error().what);
  }

  int inputs() const override {
    if (isf_.head.input(kStart) && isf_.head.input(kEnd)) return 2;
    return isf_.head.input(kInput) ? 1 : 0;
  }
  Needs needs() const override { return isf_.hands->needs(); }
  bool is_stale() const override { return files_.have_changed(); }

  Result<void> set(std::string_view name, std::string_view value) override {
    if (auto set = SettableSource::set(name, value); !set) return set;
    const auto* input = isf_.head.input(name);
    if (input && input->type == Type::event) events_.emplace(name);
    if (!input || !input->is_image()) return {};
    if (auto usable = graphics_->use(); !usable) return usable;
    return load(std::string(name), std::string(value));
  }

  Result<bool> draw(const Moment& moment, Views inputs, renderer::Texture& out) override {
    const bool is_changed = take_change();
    if (isf_.is_still && this->inputs() == 0 && !is_changed && has_drawn_) return false;
    if (auto usable = graphics_->use(); !usable) return tl::make_unexpected(usable.error());
    upload(inputs);
    hear();
    isf_.hands->update(*graphics_, moment);
    const Target* last = &output_;
    for (std::size_t i = 0; i < isf_.head.passes.size(); ++i)
      last = draw_pass(i, moment, is_changed || !has_drawn_);
    read(*last, out);
    events_.clear();
    has_drawn_ = true;
    if (auto good = graphics_->check(); !good) return tl::make_unexpected(good.error());
    return true;
  }

 private:
  Result<void> load(const std::string& name, const fs::path& file) {
    const auto picture = renderer::read_premultiplied_picture(file);
    if (!picture) return fail_in(name, picture.error());
    graphics_->upload(images_[name], picture->view(), true);
    return {};
  }

  void upload(Views inputs) {
    if (inputs.size() == 1) graphics_->upload(images_[std::string(kInput)], inputs[0], true);
    if (inputs.size() != 2) return;
    graphics_->upload(images_[std::string(kStart)], inputs[0], true);
    graphics_->upload(images_[std::string(kEnd)], inputs[1], true);
  }

  /// Fills the images of sound.
  void hear() {
    std::optional<Heard> heard;
    for (const auto& input : isf_.head.inputs) {
      if (input.type < Type::audio) continue;
      // Only a shader that is drawn needs the device.
      if (!ears_) ears_.emplace(sound_device_);
      if (!heard) heard = ears_->listener.newest();
      const int all = input.type == Type::audio ? kWaveform : Spectrum::kBins,
                width = input.most_samples > 0 ? input.most_samples : all;
      const auto image = input.type == Type::audio ? waveform_of(*heard, width)
                                                   : ears_->spectrum.image_of(*heard, width);
      graphics_->upload_levels(images_[input.name()], image.width, image.height, image.levels);
    }
  }

  void set_inputs(const UserProgram& program, const Moment& moment) {
    program.set("TIME", static_cast<float>(moment.time_s));
    program.set("TIMEDELTA", static_cast<float>(moment.step_s));
    program.set("FRAMEINDEX", static_cast<int>(moment.frame & 0x7fffffff));
    const std::tm& date = moment.date;
    program.set("DATE", glm::vec4(date.tm_year + 1900, date.tm_mon + 1, date.tm_mday,
                                  static_cast<float>(moment.day_s)));
    isf_.hands->set(program, moment);
    for (const auto& input : isf_.head.inputs)
      if (!input.is_image()) set_input(program, input, moment);
  }

  void set_input(const UserProgram& program, const IsfInput& input, const Moment& moment) {
    const auto name = name_in_glsl(input.name());
    if (is_given(isf_.head, input.name())) {
      program.set(name, static_cast<float>(moment.progress));
      return;
    }
    const auto value = numbers(input.name());
    const auto at = [&](std::size_t i) { return static_cast<float>(value[i]); };
    switch (input.type) {
      case Type::event:
        program.set(name, events_.contains(input.name()) ? 1 : 0);
        break;
      case Type::flag:
      case Type::whole:
        program.set(name, static_cast<int>(std::lround(value[0])));
        break;
      case Type::number:
        program.set(name, at(0));
        break;
      case Type::point:
        program.set(name, glm::vec2(at(0), at(1)) *
                              (input.is_in_pixels ? glm::vec2(width_, height_) : glm::vec2(1)));
        break;
      default:
        program.set(name, glm::vec4(at(0), at(1), at(2), at(3)));
    }
  }

  int size_of(const std::optional<Expression>& size, int whole) const {
    if (!size) return whole;
    const double value = size->value([&](std::string_view name) -> std::optional<double> {
      if (name == "WIDTH") return width_;
      if (name == "HEIGHT") return height_;
      const auto* input = isf_.head.input(name);
      if (!input || input->is_image() || is_given(isf_.head, name)) return std::nullopt;
      return numbers(name)[0];
    });
    const double most = Graphics::kLargestSide;
    return static_cast<int>(std::clamp(std::isfinite(value) ? std::floor(value) : 1, 1., most));
  }

  /// The target of a pass, in its size.
  Target& target_of(const IsfPass& pass) {
    if (pass.target.empty()) return output_;
    const int width = size_of(pass.width, width_), height = size_of(pass.height, height_);
    Buffer& buffer = buffers_[pass.target];
    const GLenum format = pass.is_float ? GL_RGBA32F : GL_RGBA8;
    for (Target* const target : {&buffer.last, &buffer.next})
      if (target->texels.width != width || target->texels.height != height)
        *target = graphics_->make_target(format, width, height);
    return buffer.next;
  }

  /// Draws a pass, one that is drawn once only if that `is_due`. Returns its picture.
  const Target* draw_pass(std::size_t index, const Moment& moment, bool is_due) {
    const IsfPass& pass = isf_.head.passes[index];
    if (pass.is_drawn_once && !is_due) return &buffers_[pass.target].last;
    Target& target = target_of(pass);
    bind_images();
    const auto& program = isf_.programs[index];
    set_inputs(program, moment);
    program.set("RENDERSIZE", glm::vec2(target.texels.width, target.texels.height));
    graphics_->functions().UseProgram(program.name());
    graphics_->draw(target, true);
    if (pass.target.empty()) return &output_;
    Buffer& buffer = buffers_[pass.target];
    std::swap(buffer.last, buffer.next);
    return &buffer.last;
  }

  void bind_images() {
    GLuint unit = 0;
    const auto bind = [&](const Texels& texels) {
      const bool is_there = texels.width > 0;
      graphics_->functions().BindTextureUnit(
          unit++, (is_there ? texels : graphics_->nothing()).image.name());
    };
    for (const auto& name : isf_.images) {
      const auto buffer = buffers_.find(name);
      bind(buffer != buffers_.end() ? buffer->second.last.texels : images_[name]);
    }
    for (const auto* map : isf_.hands->images()) bind(*map);
  }

  void read(const Target& last, renderer::Texture& out) {
    if (last.texels.width == width_ && last.texels.height == height_)
      return graphics_->read(last, out);
    renderer::Texture picture;
    graphics_->read(last, picture);
    out = scaled(std::as_const(picture).view(), width_, height_);
  }

  std::shared_ptr<Graphics> graphics_;  // first: the objects below are of it
  IsfProgram isf_;
  int width_, height_;
  FileTimes files_;
  Target output_;
  std::map<std::string, Buffer> buffers_;  ///< by their targets
  std::map<std::string, Texels> images_;
  std::set<std::string, std::less<>> events_;  ///< that the next picture sees
  std::string sound_device_;
  std::optional<Ears> ears_;  ///< of a shader with sound, from its first picture on
  bool has_drawn_ = false;
};

}  // namespace

Result<std::unique_ptr<Source>> open_isf(const Opening& opening) {
  auto graphics = Graphics::open();
  if (!graphics) return tl::make_unexpected(graphics.error());
  if (auto usable = (*graphics)->use(); !usable) return tl::make_unexpected(usable.error());
  const fs::path file = opening.element.what;
  auto isf = IsfProgram::make(**graphics, file, opening);
  if (!isf) return tl::make_unexpected(isf.error());
  auto source = std::make_unique<IsfSource>(std::move(*graphics), std::move(*isf), opening);
  source->load_imports(file.parent_path());
  return source;
}

}  // namespace handcast::content
