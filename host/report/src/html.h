#pragma once

#include <string>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/report/table.h>

/// Parts of an HTML page. Texts are escaped here, and only here.
namespace tether::report {

/// A <table> with caption, headings that say what they head, and the notes below.
std::string to_html(const Table& table);

/// <tag>text</tag>
std::string element(const std::string& tag, const std::string& text);
/// The texts as <ul>.
std::string list(const std::vector<std::string>& texts);
/// What the reader must not miss; empty where there is nothing.
std::string problems_box(const std::vector<std::string>& lines);
/// What one opens to read: `inner` is HTML.
std::string folded(const std::string& summary, const std::string& inner);
/// A <figure>: `drawing` is inline SVG.
std::string figure(const std::string& drawing, const std::string& caption, const std::string& kind);

/// What the numbers rest on, the digests of files folded.
std::string basis_html(const campaign::CampaignResults& results);

/// The whole page. `body` is HTML.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace tether::report
