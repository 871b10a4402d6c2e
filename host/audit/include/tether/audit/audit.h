#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tether/record/reader.h>

namespace tether::audit {

/// One breach of a rule of DESIGN section 2.
struct Finding {
  int rule = 0;  ///< 1..8; 0: the record itself is inconsistent
  std::string uav;
  std::uint64_t sequence = 0;  ///< of the interaction; 0: none
  SimTime at;                  ///< log time
  std::string what;            ///< one printable line with the figures
};

struct Verdict {
  bool synchronised = false;  ///< the policy ties ST to ET; otherwise rules 1 to 7 do not apply
  bool complete = false;      ///< the record has its end
  std::uint64_t interactions = 0;
  Duration largest_grid_error{0};  ///< worked out anew; of synchronised records
  std::vector<Finding> findings;   ///< by log time; no more than kMaxFindings
  std::uint64_t further_findings = 0;
  std::vector<std::string> notes;  ///< what a reader should know, although no rule is broken
  bool passed() const { return complete && findings.empty(); }
};

inline constexpr std::size_t kMaxFindings = 10'000;

/// Checks the rules of time from the record alone. Shares no code with the barrier that wrote it:
/// whatever it needs (grid rounding included) it works out itself. Never fails, whatever is in the
/// record. Pure; time and memory grow as n·log n.
Verdict audit(const record::Record& record);

/// The verdict with its first finding, in one line without its end.
std::string to_line(const Verdict& verdict);

/// For a person: the verdict in a line, then one line per note and per finding (at most
/// `max_findings`).
std::string to_text(const Verdict& verdict, std::size_t max_findings = 20);

}  // namespace tether::audit
