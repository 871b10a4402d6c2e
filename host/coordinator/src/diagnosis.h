#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/base/time.h>

namespace tether::coordinator {

/// One SUT at the barrier, for a person to read.
struct Party {
  std::string sut;  ///< the name it gave
  std::string uav;
  bool joined = true;
  bool computing = false;              ///< its word is the next
  ExecTime bound;                      ///< ET that it is known to have reached
  Duration silence{0};                 ///< WT since its last word
  std::optional<ExecTime> reply_at{};  ///< the earliest of its open calls
};

/// Where the SUT stands, as the second half of a sentence about it: "it was computing, last heard
/// of at ET 1.200000 s".
std::string whereabouts(const Party& party);

/// Who is waited for, since when, and who waits for it: one sentence. Empty where no SUT is: the
/// simulator has the word.
std::string who_blocks_whom(SimTime st, const std::vector<Party>& parties);

/// Before the run: the UAVs whose SUTs are waited for, and for how long by now: one sentence.
/// @pre there is one.
std::string who_has_not_joined(const std::vector<std::string>& uavs, Duration waited);

}  // namespace tether::coordinator
