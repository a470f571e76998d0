// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

namespace handcast::study {

/// The JNDs of the ten subjects that the authors of Casper DPM published, ms: without and with the
/// fill.
inline constexpr std::array<double, 10> kPapersBaseline{4.23, 3.14, 3.86, 3.55, 2.78,
                                                        4.88, 0.22, 0.93, 3.38, 3.87};
inline constexpr std::array<double, 10> kPapersFill{6.86, 3.38, 4.41, 18.64, 2.97,
                                                    4.60, 4.20, 6.68, 3.89,  10.57};

}  // namespace handcast::study
