#include "pages/html.h"

#include "pages/page_style.h"
#include "plots/inks.h"
#include "plots/svg.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <tether/report/report.h>

namespace tether::report {
namespace {

/// What is wider than the page scrolls, also by keyboard; `name` is what a screen reader says
/// there, as HTML.
std::string scrolling(const std::string& name, const std::string& inner) {
  return fmt::format(
      "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"{}\">{}</div>", name,
      inner);
}

/// The name of the first picture, as HTML.
std::string name_of(const std::string& drawing) {
  constexpr std::string_view kName = "aria-label=\"";
  const std::size_t at = drawing.find(kName);
  if (at == std::string::npos) return "Figure";
  const std::size_t begin = at + kName.size();
  return drawing.substr(begin, drawing.find('"', begin) - begin);
}

std::string spanned(const Heading& heading) {
  return heading.columns > 1 ? fmt::format(" colspan=\"{}\"", heading.columns) : "";
}

std::string heading_cell(const Heading& heading, bool of_words) {
  const std::string kind = of_words ? " class=\"words\"" : "";
  if (heading.text.empty()) return fmt::format("<td{}{}></td>", kind, spanned(heading));
  return fmt::format("<th scope=\"{}\"{}{}>{}</th>", heading.columns > 1 ? "colgroup" : "col", kind,
                     spanned(heading), escape_markup(heading.text));
}

bool is_empty(const std::vector<Heading>& row) {
  return std::ranges::all_of(row, [](const Heading& heading) { return heading.text.empty(); });
}

std::string head(const Table& table) {
  std::string html;
  for (const auto& row : table.headings) {
    if (is_empty(row)) continue;
    html += "<tr>";
    std::size_t column = 0;
    for (const Heading& heading : row) {
      html += heading_cell(heading, column < table.text_columns);
      column += heading.columns;
    }
    html += "</tr>\n";
  }
  return html.empty() ? "" : "<thead>\n" + html + "</thead>\n";
}

std::string body_row(const std::vector<std::string>& row, std::size_t text_columns) {
  std::string html = "<tr>";
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string text = escape_markup(row[i]);
    if (i == 0) {
      html += fmt::format("<th scope=\"row\" class=\"words\">{}</th>", text);
    } else {
      html += fmt::format("<td{}>{}</td>", i < text_columns ? " class=\"words\"" : "", text);
    }
  }
  return html + "</tr>\n";
}

}  // namespace

std::string to_html(const Table& table, const std::string& name) {
  const std::string own_name = escape_markup(table.title.empty() ? name : table.title);
  std::string inner = table.title.empty() ? fmt::format("<table aria-label=\"{}\">\n", own_name)
                                          : "<table>\n" + element("caption", table.title) + "\n";
  inner += head(table) + "<tbody>\n";
  for (const auto& row : table.rows) inner += body_row(row, table.text_columns);
  std::string html = scrolling(own_name, inner + "</tbody>\n</table>") + "\n";
  if (table.notes.empty()) return html;
  html += "<ul class=\"notes\">";
  for (const std::string& note : table.notes) html += element("li", note);
  return html + "</ul>\n";
}

std::string element(const std::string& tag, const std::string& text) {
  return fmt::format("<{0}>{1}</{0}>", tag, escape_markup(text));
}

std::string list(const std::vector<std::string>& texts) {
  std::string html = "<ul>";
  for (const std::string& text : texts) html += element("li", text);
  return html + "</ul>\n";
}

std::string problems_box(const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  return "<section class=\"problems\" aria-label=\"Problems\">\n" + element("h2", "Problems") +
         list(lines) + "</section>\n";
}

std::string folded(const std::string& summary, const std::string& inner) {
  return fmt::format("<details>{}\n{}</details>\n", element("summary", summary), inner);
}

std::string figure(const std::string& drawing, const std::string& caption,
                   const std::string& kind) {
  return fmt::format("<figure class=\"{}\">{}{}</figure>\n", kind,
                     scrolling(name_of(drawing), drawing),
                     caption.empty() ? "" : element("figcaption", caption));
}

std::string basis_html(const campaign::CampaignResults& results) {
  Table table = basis_table(results);
  table.title.clear();
  Table files;
  files.text_columns = table.text_columns;
  const auto is_file = [](const auto& row) { return row.front().starts_with("file "); };
  std::copy_if(table.rows.begin(), table.rows.end(), std::back_inserter(files.rows), is_file);
  std::erase_if(table.rows, is_file);
  std::string html = to_html(table, "Setup and checks");
  if (!files.rows.empty())
    html += folded("Digests of all files", to_html(files, "Digests of all files"));
  return html;
}

std::string html_page(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "{}\n<style>{}{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
      element("title", title), kPageStyle, ink_css(), body);
}

}  // namespace tether::report
