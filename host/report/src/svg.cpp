#include "svg.h"

#include "inks.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace tether::report {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

void drop_elements(std::string& svg, std::string_view open, std::string_view close) {
  for (auto at = svg.find(open); at != std::string::npos; at = svg.find(open, at)) {
    const auto end = svg.find(close, at);
    if (end == std::string::npos) return;
    svg.erase(at, end + close.size() - at);
  }
}

// gnuplot opens a group per pen that it takes up, drawn with or not.
void drop_empty_groups(std::string& svg) {
  constexpr std::string_view kOpen = "<g ", kClose = "</g>\n";
  std::string kept;
  std::size_t from = 0;
  for (auto at = svg.find(kOpen); at != std::string::npos; at = svg.find(kOpen, at + 1)) {
    const auto end = svg.find('>', at);
    if (end == std::string::npos) break;
    const auto next = svg.find_first_not_of(" \t\n", end + 1);
    if (next == std::string::npos || svg.compare(next, kClose.size(), kClose) != 0) continue;
    kept.append(svg, from, at - from);
    from = next + kClose.size();
  }
  svg = kept.append(svg, from);
}

// Colours of one tag.

struct Attribute {
  std::string_view name;  // "stroke", "fill", "color"
  std::size_t begin;      // of its value
  std::size_t end;
};

std::optional<Attribute> find_colour(std::string_view tag, std::size_t from) {
  const auto begin = tag.find("rgb(", from);
  if (begin == std::string_view::npos) return std::nullopt;
  const auto end = tag.find(')', begin);
  const auto equals = tag.rfind('=', begin);
  if (end == std::string_view::npos || equals == std::string_view::npos) return std::nullopt;
  for (const std::string_view name : {"stroke", "fill", "color"}) {
    const std::string_view before = tag.substr(0, tag.find_last_not_of(" =", equals) + 1);
    if (before.ends_with(name)) return Attribute{name, begin, end + 1};
  }
  return std::nullopt;
}

std::string with_classes(std::string tag, const std::string& classes) {
  if (const auto at = tag.find("class=\""); at != std::string::npos)
    return tag.insert(at + std::string_view("class=\"").size(), classes + " ");
  const std::size_t end = tag.ends_with("/>") ? tag.size() - 2 : tag.size() - 1;
  return tag.insert(end, fmt::format(" class=\"{}\"", classes));
}

std::string inked_tag(std::string_view tag) {
  std::string inked, classes;
  std::size_t from = 0;
  while (const auto colour = find_colour(tag, from)) {
    const std::string_view value = tag.substr(colour->begin, colour->end - colour->begin);
    const auto ink = find_ink(value);
    inked += tag.substr(from, colour->begin - from);
    inked += ink ? light_colour(*ink) : value;
    if (ink) {
      classes += fmt::format("{}tp-{}-{}", classes.empty() ? "" : " ", colour->name,
                             static_cast<std::size_t>(*ink));
    }
    from = colour->end;
  }
  inked += tag.substr(from);
  return classes.empty() ? inked : with_classes(std::move(inked), classes);
}

std::string inked(std::string_view svg) {
  std::string text;
  std::size_t from = 0;
  for (auto at = svg.find('<'); at != std::string_view::npos; at = svg.find('<', from)) {
    const auto end = svg.find('>', at);
    if (end == std::string_view::npos) break;
    text += svg.substr(from, at - from);
    text += inked_tag(svg.substr(at, end + 1 - at));
    from = end + 1;
  }
  return text.append(svg.substr(from));
}

void add_title_and_style(std::string& svg, const std::string& title) {
  const auto open = svg.find("<svg");
  const auto end = svg.find('>', open);
  if (open == std::string::npos || end == std::string::npos) return;
  const std::string text = escape_markup(title);
  svg.insert(end + 1, fmt::format("\n<title>{}</title>\n<style>{}</style>", text, ink_css()));
  svg.insert(open + 4, fmt::format(" role=\"img\" aria-label=\"{}\"", text));
}

}  // namespace

std::string escape_markup(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      case '\n':
      case '\t':
        escaped += c;
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20) escaped += c;
    }
  }
  return escaped;
}

std::string finished_svg(std::string_view drawn, const std::string& title) {
  std::string svg(drawn);
  drop_elements(svg, "<title>", "</title>");
  drop_elements(svg, "<desc>", "</desc>");
  drop_elements(svg, "<filter ", "</filter>");
  replace_all(svg, "xlink:href", "href");
  drop_empty_groups(svg);
  svg = inked(svg);
  add_title_and_style(svg, title);
  return svg;
}

std::string inline_svg(std::string_view finished, const std::string& prefix) {
  std::string svg(finished);
  svg.erase(0, std::min(svg.find("<svg"), svg.size()));
  drop_elements(svg, "<style>", "</style>");
  for (const std::string_view reference : {" id='", " id=\"", "href='#", "href=\"#", "url(#"})
    replace_all(svg, reference, std::string(reference) + prefix);
  return svg;
}

}  // namespace tether::report
