#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/report/table.h>

/// Parts of an HTML page. Texts are escaped here and nowhere else.
namespace tether::report {

/// A <table> with caption, headings with their scope, and the notes below.
/// @param name of a table without a title, for screen readers
std::string to_html(const Table& table, const std::string& name = "Table");

/// <tag>text</tag>
std::string element(const std::string& tag, const std::string& text);
/// The texts as <ul>.
std::string list(const std::vector<std::string>& texts);
/// A box with the problems; empty if there are none.
std::string problems_box(const std::vector<std::string>& lines);
/// A section that the reader unfolds. `inner` is HTML.
std::string folded(const std::string& summary, const std::string& inner);
/// A <figure>: `drawing` is inline SVG.
std::string figure(const std::string& drawing, const std::string& caption, const std::string& kind);

/// The caption of a plot of paths.
inline constexpr std::string_view kPathCaption =
    "Ticks show the heading. A dashed line is the dead reckoning of the SUT, from the true start.";

/// The table of setup and checks, with the digests of files folded.
std::string basis_html(const campaign::CampaignResults& results);

/// The whole page. `body` is HTML.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace tether::report
