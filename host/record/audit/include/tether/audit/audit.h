#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tether/record/reader.h>

namespace tether::audit {

/// A breach of a rule of DESIGN section 2.
struct Finding {
  int rule = 0;  ///< 1..8; 0: the record itself is inconsistent
  std::string uav;
  std::uint64_t sequence = 0;  ///< of the interaction or command; 0: none
  SimTime at;                  ///< log time
  std::string what;            ///< one printable line with numbers
};

struct Verdict {
  bool synchronised = false;  ///< under the barrier; otherwise rules 1 to 7 do not apply
  bool complete = false;      ///< the record has its end
  SimTime reached;            ///< log time of its last message
  std::uint64_t interactions = 0;
  Duration largest_grid_error{0};  ///< computed again; for synchronised records
  std::vector<Finding> findings;   ///< by log time; at most kMaxFindings
  std::uint64_t further_findings = 0;
  std::vector<std::string> notes;  ///< remarks that are not breaches
  bool passed() const { return complete && findings.empty(); }
};

inline constexpr std::size_t kMaxFindings = 10'000;

/// Checks the rules of time from the record alone. The audit shares no code with the barrier that
/// wrote the record, not even the rounding to the grid. It accepts any record. Pure; time and
/// memory grow as n·log n.
Verdict audit(const record::Record& record);

/// The verdict with its first finding, in one line without a newline.
std::string to_line(const Verdict& verdict);

/// For a person: one line with the verdict, then one line per note and per finding (at most
/// `max_findings`).
std::string to_text(const Verdict& verdict, std::size_t max_findings = 20);

}  // namespace tether::audit
