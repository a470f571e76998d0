// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/gl_painter.hpp"

#include "tests/renderer/draw/painter_contract.hpp"

namespace handcast::renderer::test {

std::unique_ptr<Painter> make_gl_painter(int width_px, int height_px) {
  auto painter = open_gl_painter(width_px, height_px);
  return painter ? std::move(*painter) : nullptr;
}

INSTANTIATE_TEST_SUITE_P(gl, PainterContract, testing::Values(&make_gl_painter),
                         [](const auto&) { return "without_window"; });

}  // namespace handcast::renderer::test
