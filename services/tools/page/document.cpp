// SPDX-License-Identifier: Apache-2.0
#include "services/tools/page/document.hpp"

#include <fmt/format.h>

#include "services/tools/page/html.hpp"
#include "services/tools/page/style.hpp"

namespace handcast::page {

static constexpr const char* kSkeleton = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{{title}}</title>
<style>{{style}}</style>
</head>
<body>
<main>
<header>
<h1>{{title}}</h1>
<dl>{{facts}}</dl>
{{header}}</header>
{{body}}</main>
</body>
</html>
)html";

std::string to_html(const Document& document) {
  return fill(kSkeleton, {{"title", escape(document.title)},
                          {"style", std::string(kStyle) + document.style},
                          {"facts", document.facts},
                          {"header", document.header},
                          {"body", document.body}});
}

std::string fact(std::string_view name, std::string_view value) {
  return value.empty()
             ? ""
             : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape(name), escape(value));
}

}  // namespace handcast::page
