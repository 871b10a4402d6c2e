#pragma once

#include "command_queue.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/time.h>
#include <tether/record/messages.h>
#include <tether/record/writer.h>
#include <tether/sim/simulator.h>

namespace tether::coordinator {

/// The record cannot be written any more.
struct RecordFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Writes the record of a run, and keeps the figures of its footer. Errors of the recorder are
/// thrown as RecordFailure.
///
/// The record of a *repeatable* run is the same to the byte each time. It has no wall times and no
/// state of the machine. With several SUTs, the messages of one ST are collected and written in the
/// order of (time of the SUT, index of the SUT), because which SUT acts first at one ST is a race.
/// Only messages that the rules of time leave unordered change places: a reply that was sent too
/// early stays where it was, and the audit finds it.
class RunLog {
 public:
  explicit RunLog(record::Recorder& recorder) : recorder_(&recorder) {}

  void begin(record::Header header, bool repeatable);
  void interaction(SimTime st, record::Interaction entry);
  void command_effect(SimTime st, const std::string& uav, const CommandEffect& effect);
  /// The footer keeps the least clearance.
  void ground_truth(const std::string& uav, const sim::GroundTruth& truth,
                    const std::optional<sim::Clearance>& clearance);
  void contact(SimTime st, const std::string& uav, const sim::Contact& contact);
  void battery(SimTime st, const std::string& uav, const energy::Status& status);
  void annotation(SimTime st, record::Annotation annotation) { put(st, std::move(annotation)); }
  void stop(SimTime st, const record::Stop& stop);
  void radio(SimTime st, record::RadioMessage message) { in_order(st, std::move(message)); }
  void link(SimTime st, record::AutopilotMessage message) { in_order(st, std::move(message)); }
  void image(SimTime st, const std::string& uav, const std::string& sensor,
             const uav::CameraSample& sample);
  /// Once a second of WT, so that a killed run leaves most of it.
  void flush(WallTime now);
  /// Writes the footer.
  void end();

  /// From here on, until `race_again`, messages are written as they come, as at the start: what is
  /// due when ST reaches a boundary has a fixed order.
  void settle();
  void race_again() { collects_ = repeatable_ && rows_.size() > 1; }

  /// With the figures so far.
  record::Footer& footer() { return footer_; }
  const record::Footer& footer() const { return footer_; }
  std::uint64_t images() const { return images_; }
  void count_image() { ++images_; }

 private:
  struct Collected {
    SimTime st;
    std::pair<ExecTime, std::size_t> key;
    record::Message message;
  };
  struct Row {
    std::size_t index;
    ExecTime reached;  // time of its last interaction
  };

  void in_order(SimTime st, record::Message message);
  void take_clearance(SimTime st, const std::string& uav, const sim::Clearance& clearance);
  void put(SimTime st, record::Message message);
  void write(SimTime st, record::Message& message);
  static bool may_precede(const Collected& later, const Collected& earlier);

  record::Recorder* recorder_;
  record::Footer footer_;
  std::map<std::string, std::size_t> clearance_at_;  // in the footer, by UAV
  std::uint64_t images_ = 0;                         // rendered because a SUT read them
  WallTime flushed_{};
  bool repeatable_ = false;
  bool collects_ = false;
  std::map<std::string, Row> rows_;                            // by UAV
  std::vector<Collected> collected_;                           // of one ST
  std::vector<std::pair<SimTime, record::Message>> in_order_;  // the same, after those
};

}  // namespace tether::coordinator
