#pragma once

#include "exact.h"
#include "report.h"

#include <tether/record/reader.h>

/// The parts of the audit. Each reads the whole record and is independent of the others.
namespace tether::audit {

/// As whose messages SUTs receive those of their flight controllers.
inline constexpr const char* kAutopilot = "autopilot";

/// Rules 1 to 7 for each interaction alone.
void check_interactions(const record::Record& record, const Boundaries& grid, Report& report);

/// Rules 4 and 5 for each serial SUT: every interaction is compared with the previous one.
void check_rows(const record::Record& record, Report& report);

/// Rules 4 and 5 for each concurrent SUT: its requests in the order of their sequence, its replies
/// and its stops.
void check_stops(const record::Record& record, const Boundaries& grid, Report& report);

/// Rule 1: whether each read returned the right measurement, given the previous reads.
void check_newness(const record::Record& record, Report& report);

/// Rule 1: a sample that a driver loses was not read, and a repeated one has the content of the one
/// before. Rule 0: its stamp is the one that the driver gives it. For any policy.
void check_stamps(const record::Record& record, Report& report);

/// Rule 5 on boards that several SUTs share: on a virtual one, each computes with its share of the
/// cores; on a real one, all of them stop together.
void check_boards(const record::Record& record, Report& report);

/// When a command arrives at the flight controller: the first set-point takes effect then.
Wide arrival_of(const record::Interaction& command, const record::SutInfo& sut);

/// Rule 2 for any policy: what takes effect is what was commanded.
void check_setpoints(const record::Record& record, Report& report);

/// Rule 2 and the second half of rule 3: the effects of commands.
void check_commands(const record::Record& record, const Boundaries& grid, Report& report);

/// Messages between UAVs. Rule 0: each one that was sent has one fate at each receiver. For
/// synchronised records also rule 1, no message is received before it can have arrived, and rule 3,
/// none is received late or out of order.
void check_radio(const record::Record& record, const Boundaries& grid, Report& report);

/// Messages between flight controllers and their SUTs. Rules 1 and 2: each arrives when the line
/// has brought it, and the controller takes it at its first step from there on. Rule 3: in order,
/// and none is lost but where there was no room.
void check_autopilot(const record::Record& record, Report& report);

/// Rule 0: what became of each message follows from the settings of the radio, the positions of the
/// UAVs and the draws. Only if the header has the settings.
void check_channel(const record::Record& record, const Boundaries& grid, Report& report);

/// Rule 0: charge, voltage, current and energy by cause agree with each other, and with what was
/// computed, by the battery's model in the header. Rule 1 for readings of the battery: what it had
/// at that ST, by the battery's channel.
void check_battery(const record::Record& record, Report& report);

/// Rules 3 and 4 across SUTs: replies are sent in the order of their timestamps, and ST never
/// passes a SUT that can still act, in the order of the file and of wall time.
void check_order(const record::Record& record, const Boundaries& grid, Report& report);

/// Rule 0 for any policy: header, numbering, ground truth, log times, wall times.
void check_consistency(const record::Record& record, const Boundaries& grid, Report& report);

/// Rule 0 for any policy: poses, velocities and clearances describe one flight, which the UAV can
/// fly; no command is beyond what a SUT can give.
void check_motion(const record::Record& record, Report& report);

/// Rule 0 for any policy: the joints of UAVs turn as they were commanded.
void check_joints(const record::Record& record, Report& report);

/// Rule 0 for any policy: contacts agree with the ground truth around them, and a UAV that comes to
/// touch something has one.
void check_contacts(const record::Record& record, Report& report);

/// Rule 0: the footer's figures and numbers of messages, and how the run ended; for synchronised
/// runs also the times at the end.
void check_end(const record::Record& record, const Boundaries& grid, Report& report);

}  // namespace tether::audit
