#pragma once

#include <string>

#include <tether/base/result.h>
#include <tether/rig/mission.h>

/// Mission files (docs/guide/tasks.md): TOML with a `[[task]]` table for each task, whose keys are
/// the options of that task's subcommand with underscores (`--precision-deg` → `precision_deg`),
/// and those of mission::task_keys. Clauses are checked, and are otherwise for the host.
namespace tether::rig {

/// Reads a mission file. Fails with kInvalid and one line: FILE:LINE and what is wrong.
Result<Mission> load_mission(const std::string& path);
/// The same from the file's text; `path` is for the messages.
Result<Mission> parse_mission(const std::string& text, const std::string& path);

}  // namespace tether::rig
