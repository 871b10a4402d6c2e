#include "checks.h"

#include <algorithm>

#include <tether/audit/audit.h>

namespace tether::audit {

Verdict audit(const record::Record& record) {
  Verdict verdict;
  Report report(verdict);
  verdict.synchronised = record.header.policy == record::kConservativeBarrier;
  verdict.complete = record.footer.has_value();
  verdict.reached = record::last_time(record);
  verdict.interactions = record.interactions.size();
  if (!verdict.synchronised && record.header.policy != record::kFreeRunning) {
    report.add("unknown policy \"" + record.header.policy + "\"");
  }
  if (record.header.step <= Duration(0)) {
    report.add("the step of the simulator is not positive");
    return verdict;
  }

  const Boundaries grid(record.header.step);
  check_consistency(record, grid, report);
  check_setpoints(record, report);
  check_motion(record, report);
  check_joints(record, report);
  check_contacts(record, report);
  check_radio(record, grid, report);
  check_autopilot(record, report);
  check_channel(record, grid, report);
  check_battery(record, report);
  check_stamps(record, report);
  if (verdict.synchronised) {
    check_interactions(record, grid, report);
    check_rows(record, report);
    check_stops(record, grid, report);
    check_newness(record, report);
    check_boards(record, report);
    check_commands(record, grid, report);
    check_order(record, grid, report);
  }
  check_end(record, grid, report);
  std::ranges::stable_sort(verdict.findings, {}, &Finding::at);
  return verdict;
}

}  // namespace tether::audit
