#pragma once

#include <tether/record/reader.h>
#include <tether/report/table.h>

namespace tether::report {

/// The links between UAVs: messages that arrived, those that were lost by cause, and delays. No
/// rows: no message was sent.
Table radio_table(const record::Record& record);

}  // namespace tether::report
