#pragma once

#include "exact.h"
#include "report.h"

#include <tether/record/reader.h>

/// The audit's parts. Each reads the record on its own and knows nothing of the others.
namespace tether::audit {

/// Rules 1 to 7 of each interaction by itself.
void check_interactions(const record::Record& record, const Boundaries& grid, Report& report);

/// Rules 4 and 5 of each serial SUT: every interaction against the one before.
void check_rows(const record::Record& record, Report& report);

/// Rules 4 and 5 of each concurrent SUT: its requests in the order of their sequence, its replies,
/// and where all of it stood still.
void check_stops(const record::Record& record, const Boundaries& grid, Report& report);

/// Rule 1: which measurement a read got, by what had been read before.
void check_newness(const record::Record& record, Report& report);

/// Rule 2 and the second half of rule 3: what became of the commands.
void check_commands(const record::Record& record, const Boundaries& grid, Report& report);

/// Rule 4 across SUTs: ST never runs ahead of anyone who may still act, in file order and in the
/// order of wall time.
void check_order(const record::Record& record, const Boundaries& grid, Report& report);

/// Rule 0, whatever the policy: header, numbering, ground truth, log times.
void check_consistency(const record::Record& record, const Boundaries& grid, Report& report);

/// Rule 0: the footer's figures against the record; of synchronised runs also the times at the end.
void check_end(const record::Record& record, const Boundaries& grid, Report& report);

}  // namespace tether::audit
