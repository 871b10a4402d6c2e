#pragma once

#include <string>

#include <tether/workers/worker.h>

/// The text of the small files that workers write.
namespace tether::workers {

std::string text_of(const WorkerName& self, const std::string& why = "");
std::string text_of(const WorkerState& state);

}  // namespace tether::workers
