#pragma once

#include <string>
#include <vector>

#include <tether/report/verdict.h>

/// The beginning of a page.
namespace tether::report {

/// A sentence whose lead stands out.
std::string answer_line(const Answer& answer);
/// The answers on one scenario and, if there are any, what to do next: the most important part of
/// the page.
/// @param heading "h2", or "h3" below an h2
std::string answer_block(const std::vector<Answer>& answers, const std::vector<std::string>& advice,
                         const std::string& heading = "h2");
/// … of its verdict, or of the points of its sweep.
std::string answer_html(const std::vector<Verdict>& points, const std::string& heading = "h2");
/// The first answer on each scenario.
std::string answers_html(const std::vector<std::vector<Verdict>>& groups);

/// The flights and the computing per image of each condition, as a figure.
std::string verdict_picture_html(const std::vector<std::vector<Verdict>>& groups);

}  // namespace tether::report
