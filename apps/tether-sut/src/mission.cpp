#include "mission.h"

#include <memory>

#include <tether/tasks/task_context.h>

namespace tether::sut {
namespace {

using TaskPointer = std::unique_ptr<tasks::Task>;

struct TaskMaker {
  const std::string& anchor;

  TaskPointer operator()(const tasks::RelativePositionOptions& options) const {
    return std::make_unique<tasks::RelativePositionTask>(anchor, options);
  }
  TaskPointer operator()(const tasks::FaceAnchorOptions& options) const {
    return std::make_unique<tasks::FaceAnchorTask>(anchor, options);
  }
  TaskPointer operator()(const tasks::MoveForwardOptions& options) const {
    return std::make_unique<tasks::MoveForwardTask>(anchor, options);
  }
  TaskPointer operator()(const tasks::ClosedPathOptions& options) const {
    return std::make_unique<tasks::ClosedPathTask>(anchor, options);
  }
};

/// Whether nobody is left to hear how it ended.
bool is_link_gone(const tasks::TaskOutcome& outcome) {
  return outcome.failure == Failure::Kind::kDisconnected ||
         outcome.failure == Failure::Kind::kProtocol ||
         outcome.failure == Failure::Kind::kTimeout || outcome.failure == Failure::Kind::kRunEnded;
}

}  // namespace

tasks::TaskOutcome fly(const Mission& mission, client::Vehicle& vehicle) {
  tasks::TaskContext context(vehicle, mission.camera, mission.tracker);
  const TaskPointer task = std::visit(TaskMaker{mission.anchor}, mission.task);
  tasks::TaskOutcome outcome = tasks::run(*task, context);
  if (is_link_gone(outcome)) {
    return outcome;
  }
  const Status finished =
      vehicle.finish(outcome.reached(), outcome.reason, tasks::details_json(outcome));
  return finished ? outcome : tasks::TaskOutcome::failed(finished.failure());
}

int exit_code(const tasks::TaskOutcome& outcome) {
  if (outcome.failure) {
    return exit_code(Failure{*outcome.failure, outcome.reason});
  }
  return outcome.reached() ? 0 : 1;
}

int exit_code(const Failure& failure) {
  switch (failure.kind) {
    case Failure::Kind::kInvalid:
      return 2;
    case Failure::Kind::kRunEnded:
      return 1;
    case Failure::Kind::kRefused:
    case Failure::Kind::kDisconnected:
    case Failure::Kind::kProtocol:
    case Failure::Kind::kTimeout:
      break;
  }
  return 3;
}

}  // namespace tether::sut
