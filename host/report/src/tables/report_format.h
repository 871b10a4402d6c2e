#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <tether/campaign/campaign_results.h>
#include <tether/campaign/result.h>
#include <tether/report/table.h>

/// Formats of the numbers and headings of a report.
namespace tether::report {

inline constexpr const char* kNone = "–";
/// Below it, a p-value shows a difference.
inline constexpr double kSignificant = 0.05;
/// kWantedSuccess in words.
inline constexpr const char* kWanted = "9 of 10";

/// Three decimals, as in the paper.
std::string decimals(double value);
std::string decimals(const std::optional<double>& value);
/// "[1.234, 5.678]".
std::string interval(const std::optional<campaign::Interval>& value);
/// "0.012", "< 0.001".
std::string p_value(double p);
/// The shortest text that reads back as the same number; empty for none.
std::string exact(double value);
std::string exact(const std::optional<double>& value);
/// Whether a UAV hit something harder than the scenario allows.
bool has_crash(const campaign::TrialResult& trial);
/// "0.5" or, of a minimum, "≥ 0.5".
std::string limit_text(const campaign::MetricValue& metric);
/// "Time required (s)"; counts have no unit.
std::string with_unit(const std::string& label, const std::string& unit);
/// "Time required" → "time required"; "ROI error" stays.
std::string in_a_sentence(std::string label);
/// With a capital letter.
std::string capital(std::string_view text);
/// "9.4 ms", "108 ms"
std::string short_ms(double seconds);
/// "81 %"
std::string share_text(double value);
/// "9.0", "30"
std::string rate_text(double hz);
/// Of a margin in shares of a limit: "12 % left", "3 % beyond", "at the limit".
std::string distance_text(double margin);
/// "a, b and c"
std::string joined_with_and(const std::vector<std::string>& parts);
/// Unexpected events of a run, in one line; empty: none.
std::string notes_of(const campaign::TrialResult& trial);
/// The number that the whole text is; none: it is not one.
std::optional<double> number_in(const std::string& text);
/// A row with a heading for each column.
std::vector<Heading> single_headings(const std::vector<std::string>& texts);

}  // namespace tether::report
