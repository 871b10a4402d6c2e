#include <algorithm>
#include <string>

#include <fmt/format.h>

#include <tether/audit/audit.h>

namespace tether::audit {
namespace {

std::string headline(const Verdict& verdict) {
  const std::string truncated =
      verdict.complete ? ""
                       : fmt::format(", truncated at ST {:.6f} s", to_seconds(verdict.reached));
  const std::size_t findings = verdict.findings.size() + verdict.further_findings;
  if (findings > 0) {
    return fmt::format("FAILED: {} finding{} in {} interactions{}\n", findings,
                       findings == 1 ? "" : "s", verdict.interactions, truncated);
  }
  const std::string how =
      verdict.complete ? "passed" : "INCOMPLETE" + truncated + ", no finding before";
  if (!verdict.synchronised) {
    return fmt::format("{}: {} interactions, not synchronised: rules 1 to 7 do not apply\n", how,
                       verdict.interactions);
  }
  return fmt::format("{}: {} interactions follow the rules of time\n", how, verdict.interactions);
}

std::string line_of(const Finding& finding) {
  std::string where = fmt::format("ST {:.6f} s", to_seconds(finding.at));
  if (!finding.uav.empty()) where += fmt::format(", {}", finding.uav);
  if (finding.sequence != 0) where += fmt::format(" #{}", finding.sequence);
  const std::string rule = finding.rule == 0 ? "record" : fmt::format("rule {}", finding.rule);
  return fmt::format("{} ({}): {}", rule, where, finding.what);
}

}  // namespace

std::string to_line(const Verdict& verdict) {
  std::string text = headline(verdict);
  text.pop_back();
  if (!verdict.findings.empty()) text += ": " + line_of(verdict.findings.front());
  return text;
}

std::string to_text(const Verdict& verdict, std::size_t max_findings) {
  std::string text = headline(verdict);
  if (verdict.synchronised && verdict.findings.empty())
    text += fmt::format("  largest grid error {:.6f} ms\n",
                        to_seconds(verdict.largest_grid_error) * 1e3);
  for (const std::string& note : verdict.notes) text += fmt::format("  note: {}\n", note);
  const std::size_t shown = std::min(max_findings, verdict.findings.size());
  for (std::size_t i = 0; i < shown; ++i)
    text += fmt::format("  {}\n", line_of(verdict.findings[i]));
  const std::size_t more = verdict.findings.size() - shown + verdict.further_findings;
  if (more > 0) text += fmt::format("  … and {} more\n", more);
  return text;
}

}  // namespace tether::audit
