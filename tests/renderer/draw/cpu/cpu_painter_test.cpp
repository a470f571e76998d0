// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/cpu_painter.hpp"

#include "tests/renderer/draw/painter_contract.hpp"

namespace handcast::renderer::test {

INSTANTIATE_TEST_SUITE_P(cpu, PainterContract, testing::Values(&make_cpu_painter),
                         [](const auto&) { return "one_core"; });

}  // namespace handcast::renderer::test
