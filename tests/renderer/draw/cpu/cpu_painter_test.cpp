// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/cpu_painter.hpp"

#include "tests/renderer/draw/fill_contract.hpp"
#include "tests/renderer/draw/painter_contract.hpp"
#include "tests/renderer/draw/warp_contract.hpp"

namespace handcast::renderer::test {

static Result<std::unique_ptr<Painter>> open_cpu(int width_px, int height_px) {
  return make_cpu_painter(width_px, height_px);
}

static Result<std::unique_ptr<Painter>> open_threads(int width_px, int height_px) {
  return make_cpu_painter(width_px, height_px, 3);
}

INSTANTIATE_TEST_SUITE_P(cpu, PainterContract, testing::Values(&open_cpu, &open_threads),
                         [](const auto& each) {
                           return each.param == &open_cpu ? "one_core" : "three_threads";
                         });

}  // namespace handcast::renderer::test
