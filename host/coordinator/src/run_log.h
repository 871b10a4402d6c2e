#pragma once

#include "command_queue.h"

#include <algorithm>
#include <cstdint>

#include <tether/base/time.h>
#include <tether/record/messages.h>
#include <tether/record/writer.h>
#include <tether/sim/simulator.h>

namespace tether::coordinator {

/// Writes the record of a run, and keeps the figures of its footer.
class RunLog {
 public:
  explicit RunLog(record::Recorder& recorder) : recorder_(&recorder) {}

  void begin(const record::Header& header) { recorder_->write(header); }
  void interaction(SimTime st, const record::Interaction& entry);
  void command_effect(SimTime st, const std::string& uav, const PendingCommand& command);
  void ground_truth(const std::string& uav, const sim::GroundTruth& truth);
  void contact(SimTime st, const std::string& uav, const sim::Contact& contact);
  /// At the instant of the ground truth. The footer keeps the least.
  void clearance(SimTime st, const std::string& uav, const sim::Clearance& clearance);
  void annotation(SimTime st, const record::Annotation& annotation) {
    recorder_->write(st, annotation);
  }
  void stop(SimTime st, const record::Stop& stop);
  void image(SimTime st, const std::string& uav, const std::string& sensor,
             const uav::CameraSample& sample);
  void flush() { recorder_->flush(); }
  /// Writes the footer.
  void end() { recorder_->write(footer_); }

  /// With the figures so far.
  record::Footer& footer() { return footer_; }
  const record::Footer& footer() const { return footer_; }
  std::uint64_t images() const { return images_; }
  void count_image() { ++images_; }

 private:
  record::Recorder* recorder_;
  record::Footer footer_;
  std::uint64_t images_ = 0;  // rendered because a SUT read them
};

}  // namespace tether::coordinator
