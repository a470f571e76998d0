// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "services/evaluation/report/film.hpp"
#include "services/evaluation/report/inputs.hpp"

namespace handcast::report {

/// What a page says about its making.
struct Imprint {
  std::string title;
  std::string machine;  ///< "AMD EPYC, 2 cores, Debian 12"
  std::string date;     ///< "2025-11-21 12:00 UTC"
};

/// The whole page: one file that needs nothing beside it and no network.
std::string make_page(const Inputs& inputs, const Film& film, const Imprint& imprint);

extern const char* const kSkeleton;  ///< HTML with {{places}}
extern const char* const kStyle;     ///< CSS beyond page::kStyle

}  // namespace handcast::report
