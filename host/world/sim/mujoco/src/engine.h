#pragma once

#include <memory>
#include <string>

#include <mujoco/mujoco.h>

/// The MuJoCo engine as values with owners and exceptions.
namespace tether::sim {

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, ModelDeleter>;
using DataPtr = std::unique_ptr<mjData, DataDeleter>;

/// Compiles MJCF text in memory; nothing is written to disk.
/// @throws Error(kBadFile) with the compiler's own message; Error(kSetup) when memory runs out.
ModelPtr compile_model(const std::string& xml);
/// @throws Error(kSetup) when memory runs out.
DataPtr make_data(const mjModel& model);

/// Makes errors inside the engine Error(kInternal) and keeps it from writing log files. Idempotent.
void install_engine_handlers();

/// "2.2.2"
std::string engine_version();

}  // namespace tether::sim
