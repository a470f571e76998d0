// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/number_table.hpp"

#include <fmt/format.h>

#include "services/lab/sweep/table.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::chart {

std::string to_csv(const NumberTable& table) {
  sweep::Row header;
  for (const auto& column : table.columns) header.push_back(column.key);
  std::string csv = sweep::print_row(header);
  for (const auto& cells : table.rows) {
    sweep::Row row;
    for (const auto& cell : cells)
      row.push_back(cell.number ? fmt::format("{:.6g}", *cell.number) : cell.text);
    csv += sweep::print_row(row);
  }
  return csv;
}

static constexpr std::size_t kLongRows = 30;  ///< a table with more rows is collapsed

static std::string print(const Cell& cell, const Column& column) {
  return cell.text.empty() ? page::figure(cell.number, column.digits) : page::escape(cell.text);
}

std::string to_html(const NumberTable& table) {
  std::string html = "<div class=\"wide\"><table>\n<thead><tr>";
  for (const auto& column : table.columns)
    html +=
        fmt::format("<th scope=\"col\"{}>{}</th>", column.of_machine ? " class=\"machine\"" : "",
                    page::escape(column.heading));
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& cells : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto text = print(cells[i], table.columns[i]);
      html += i == 0 ? fmt::format("<th scope=\"row\">{}</th>", text)
                     : fmt::format("<td>{}</td>", text);
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  const bool is_long = table.rows.size() > kLongRows;
  return fmt::format(
      "<details{}><summary>{}</summary>\n<p class=\"quiet\">{} In "
      "<code>{}.csv</code>.</p>\n{}</details>\n",
      is_long ? "" : " open",
      is_long ? fmt::format("The numbers: {} rows", table.rows.size()) : "The numbers",
      page::escape(table.caption), table.name, html);
}

}  // namespace handcast::chart
