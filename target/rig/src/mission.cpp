#include <memory>
#include <utility>

#include <tether/rig/mission.h>
#include <tether/tasks/task.h>

namespace tether::rig {
namespace {

using TaskPointer = std::unique_ptr<tasks::Task>;

struct TaskMaker {
  const TaskSpec& spec;

  TaskPointer operator()(const tasks::SensorCharacterizationOptions& options) const {
    return std::make_unique<tasks::SensorCharacterizationTask>(spec.sensor, options);
  }
  TaskPointer operator()(const tasks::RelativePositionOptions& options) const {
    return std::make_unique<tasks::RelativePositionTask>(spec.anchor, options);
  }
  TaskPointer operator()(const tasks::FaceAnchorOptions& options) const {
    return std::make_unique<tasks::FaceAnchorTask>(spec.anchor, options);
  }
  TaskPointer operator()(const tasks::MoveForwardOptions& options) const {
    return std::make_unique<tasks::MoveForwardTask>(spec.anchor, options);
  }
  TaskPointer operator()(const tasks::ClosedPathOptions& options) const {
    return std::make_unique<tasks::ClosedPathTask>(spec.anchor, options);
  }
  TaskPointer operator()(const tasks::GoToOptions& options) const {
    return std::make_unique<tasks::GoToTask>(options);
  }
  TaskPointer operator()(const tasks::SearchOptions& options) const {
    return std::make_unique<tasks::SearchTask>(spec.anchor, options);
  }
  TaskPointer operator()(const tasks::SearchPairOptions& options) const {
    return std::make_unique<tasks::SearchPairTask>(spec.anchor, options);
  }
  TaskPointer operator()(const tasks::AvoidByScanOptions& options) const {
    return std::make_unique<tasks::AvoidByScanTask>(options);
  }
  TaskPointer operator()(const tasks::FlyThroughGatesOptions& options) const {
    return std::make_unique<tasks::FlyThroughGatesTask>(options);
  }
  TaskPointer operator()(const tasks::HoldOptions& options) const {
    return std::make_unique<tasks::HoldTask>(options);
  }
  TaskPointer operator()(const tasks::InspectOptions& options) const {
    return std::make_unique<tasks::InspectTask>(spec.anchor, options);
  }
  TaskPointer operator()(const tasks::LandOnOptions& options) const {
    return std::make_unique<tasks::LandOnTask>(spec.anchor, options);
  }
  TaskPointer operator()(const tasks::LandOptions& options) const {
    return std::make_unique<tasks::LandTask>(options);
  }
};

TaskPointer make_task(const TaskSpec& spec) {
  return std::visit(TaskMaker{spec}, spec.options);
}

TaskPointer make_task(const Mission& mission) {
  if (!mission.is_sequence) return make_task(mission.tasks.front());
  std::vector<tasks::SequenceItem> items;
  for (const TaskSpec& spec : mission.tasks) {
    items.push_back({make_task(spec), spec.vision, spec.required, spec.name, spec.retry,
                     spec.otherwise, spec.within, spec.before});
  }
  return std::make_unique<tasks::TaskSequence>(std::move(items));
}

}  // namespace

tasks::TaskOutcome finish(const tasks::TaskOutcome& outcome, client::Vehicle& vehicle) {
  if (outcome.failure) return outcome;
  const Status finished =
      vehicle.finish(outcome.reached(), outcome.reason, tasks::details_json(outcome));
  return finished ? outcome : tasks::TaskOutcome::failed(finished.failure());
}

tasks::TaskOutcome fly(const Mission& mission, client::Vehicle& vehicle) {
  tasks::TaskContext context(vehicle, mission.tasks.front().vision);
  const TaskPointer task = make_task(mission);
  return finish(tasks::run(*task, context), vehicle);
}

int exit_code(const tasks::TaskOutcome& outcome) {
  if (outcome.failure) return exit_code(Failure{*outcome.failure, outcome.reason});
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
    case Failure::Kind::kNothingYet:
      break;
  }
  return 3;
}

}  // namespace tether::rig
