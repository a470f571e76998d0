// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>

#include "renderer/draw/gl/passes.hpp"
#include "renderer/draw/gl/shaders.hpp"

namespace handcast::renderer::gl {
namespace {

/// One entry of the buffer `Table` of the shader.
struct Limit {
  std::uint32_t strength;
  std::uint32_t alpha;
  float squared_limit_uv;
};

constexpr int kGroup = 64;  ///< local_size_x of both shaders

}  // namespace

Result<Filler> Filler::create(Context& context, glm::ivec2 size_px) {
  auto sort = make_program(context, {{GL_COMPUTE_SHADER, "sort_compute", kSortCompute}});
  if (!sort) return tl::make_unexpected(sort.error());
  auto fill = make_program(context, {{GL_COMPUTE_SHADER, "fill_compute", kFillCompute}});
  if (!fill) return tl::make_unexpected(fill.error());
  return Filler(context, std::move(*sort), std::move(*fill), size_px);
}

Filler::Filler(Context& context, Program sort, Program fill, glm::ivec2 size_px)
    : context_(&context),
      sort_(std::move(sort)),
      fill_(std::move(fill)),
      mask_(make_image(context, GL_R8UI, size_px.x, size_px.y)),
      ring_(std::make_unique<UploadRing>(context)),
      counts_(make_buffer(context, sizeof(Counts), GL_DYNAMIC_STORAGE_BIT)),
      limits_(
          make_buffer(context, cpu::FillTable::kSquares * sizeof(Limit), GL_DYNAMIC_STORAGE_BIT)),
      counts_read_(context, sizeof(Counts), GL_MAP_READ_BIT) {
  const cpu::ShareTable shares = cpu::share_table();
  const std::vector<std::uint32_t> words(shares.begin(), shares.end());
  shares_ = make_buffer(context, words.size() * sizeof(words[0]), 0, words.data());
  const auto pixels = static_cast<std::size_t>(size_px.x) * size_px.y;
  const auto word_rows = static_cast<std::size_t>(size_px.y) / 32 + 1;
  words_ = make_buffer(context, word_rows * size_px.x * sizeof(std::uint32_t), 0);
  list_ = make_buffer(context, pixels * sizeof(std::uint32_t), 0);
}

bool Filler::upload(View<const std::uint8_t> mask, const Rect& region) {
  const auto width = static_cast<std::size_t>(region.width());
  std::byte* data = ring_->next(width * region.height());
  if (data == nullptr) return false;
  for (int y = region.y0; y < region.y1; ++y, data += width)
    std::memcpy(data, mask.row(y) + region.x0, width);
  const Functions& gl = context_->gl();
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, ring_->buffer());
  gl.TextureSubImage2D(mask_.name(), 0, region.x0, region.y0, region.width(), region.height(),
                       GL_RED_INTEGER, GL_UNSIGNED_BYTE, ring_->pointer());
  gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  ring_->sent();
  return true;
}

void Filler::set_table(const config::Fill& settings) {
  if (!table_.set_up(settings)) return;
  std::array<Limit, cpu::FillTable::kSquares> limits{};
  for (std::size_t i = 0; i < limits.size(); ++i)
    limits[i] = {table_.strength[i], table_.alpha[i], table_.squared_limit_uv[i]};
  context_->gl().NamedBufferSubData(limits_.name(), 0, sizeof limits, limits.data());
  context_->gl().ProgramUniform1i(fill_.name(), 1, table_.reach_px);
}

void Filler::bind(std::span<const HandAssets> contents, const Layers& frame) const {
  const Functions& gl = context_->gl();
  gl.BindTextureUnit(0, mask_.name());
  for (GLuint i = 0; i < contents.size(); ++i) {
    const glm::ivec4 picture = contents[i].picture->place();
    gl.BindTextureUnit(1 + i, contents[i].picture->texels.name());
    gl.ProgramUniform4i(fill_.name(), 2 + static_cast<GLint>(i), picture.x, picture.y, picture.z,
                        picture.w);
  }
  gl.BindImageTexture(0, frame.tag.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA8UI);
  gl.BindImageTexture(1, frame.colour.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  gl.BindImageTexture(2, frame.uv.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RG32F);
  const std::array buffers{words_.name(), list_.name(), counts_.name(), limits_.name(),
                           shares_.name()};
  for (GLuint i = 0; i < buffers.size(); ++i)
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]);
}

void Filler::fill(const config::Fill& settings, const Rect& region,
                  std::span<const HandAssets> contents, const Layers& frame) {
  const Functions& gl = context_->gl();
  set_table(settings);
  constexpr Counts kNone{0, 1, 1, 0, 0, 0};
  gl.NamedBufferSubData(counts_.name(), 0, sizeof kNone, &kNone);
  bind(contents, frame);
  gl.ProgramUniform4i(sort_.name(), 0, region.x0, region.y0, region.x1, region.y1);
  gl.ProgramUniform4i(fill_.name(), 0, region.x0, region.y0, region.x1, region.y1);
  gl.UseProgram(sort_.name());
  gl.DispatchCompute(static_cast<GLuint>((region.width() + kGroup - 1) / kGroup),
                     static_cast<GLuint>((region.y1 + 31) / 32 - region.y0 / 32), 1);
  gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                   GL_COMMAND_BARRIER_BIT);
  gl.UseProgram(fill_.name());
  gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, counts_.name());
  gl.DispatchComputeIndirect(0);
  gl.MemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                   GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  gl.CopyNamedBufferSubData(counts_.name(), counts_read_.buffer.name(), 0, 0, sizeof(Counts));
}

FillCounts Filler::counts() const {
  Counts counts{};
  if (counts_read_.data != nullptr) std::memcpy(&counts, counts_read_.data, sizeof counts);
  return {static_cast<int>(counts.lit), static_cast<int>(counts.filled),
          static_cast<int>(counts.wanted - counts.filled)};
}

}  // namespace handcast::renderer::gl
