#pragma once

#include "command_queue.h"

#include <algorithm>
#include <cstdint>

#include <tether/base/time.h>
#include <tether/record/messages.h>
#include <tether/record/writer.h>
#include <tether/sim/simulator.h>

namespace tether::coordinator {

/// The figures that sum a run up.
struct SyncFigures {
  std::uint64_t interactions = 0;
  std::uint64_t images = 0;
  std::uint64_t causality_violations = 0;
  Duration largest_lag{0};
  Duration largest_grid_error{0};
  std::uint64_t stops = 0;        ///< of concurrent SUTs
  Duration largest_overshoot{0};  ///< by how much one of them came after the reply for which it was
};

/// Writes what happens to the record and keeps the figures.
class RunLog {
 public:
  explicit RunLog(record::Recorder& recorder) : recorder_(&recorder) {}

  void begin(const record::Header& header) { recorder_->write(header); }
  void interaction(SimTime st, const record::Interaction& entry);
  void command_effect(SimTime st, const std::string& uav, const PendingCommand& command);
  void ground_truth(const std::string& uav, const sim::GroundTruth& truth);
  void annotation(SimTime st, const record::Annotation& annotation) {
    recorder_->write(st, annotation);
  }
  void stop(SimTime st, const record::Stop& stop);
  void image(SimTime st, const std::string& uav, const std::string& sensor,
             const uav::CameraSample& sample);
  void flush() { recorder_->flush(); }
  void end(record::Footer footer);

  const SyncFigures& figures() const { return figures_; }
  void count_image() { ++figures_.images; }

 private:
  record::Recorder* recorder_;
  SyncFigures figures_;
};

}  // namespace tether::coordinator
