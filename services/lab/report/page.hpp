// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "services/lab/report/film.hpp"
#include "services/lab/report/inputs.hpp"

namespace handcast::report {

/// Title and origin of a page.
struct Imprint {
  std::string title;    ///< plain text
  std::string machine;  ///< "AMD EPYC, 2 cores, Debian 12"
  std::string date;     ///< "2025-11-21 12:00 UTC"
};

/// The whole page: a self-contained HTML file that needs no network.
std::string make_page(const Inputs& inputs, const Film& film, const Imprint& imprint);

/// The CSS of the report, which follows page::kStyle.
extern const char* const kStyle;

}  // namespace handcast::report
