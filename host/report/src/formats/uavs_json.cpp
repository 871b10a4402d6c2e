#include <nlohmann/json.hpp>

#include <tether/report/size_report.h>
#include <tether/report/uavs_report.h>

namespace tether::report {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string uavs_json(const UavsReport& report) {
  const sizing::UavQuestion& question = report.question;
  Json json = {
      {"schema", kSizeSchemaVersion},
      {"axis", "uavs"},
      {"scenario", report.scenario},
      {"condition", report.condition},
      {"board", {{"name", report.board}, {"cores", report.cores}}},
      {"summary", Json::array()},
      {"question",
       {{"success", question.success},
        {"confidence", question.confidence},
        {"between", {question.least, question.most}},
        {"max_trials", report.most_flights}}},
      {"answer",
       {{"carried",
         report.answer.carried < question.least ? Json(nullptr) : Json(report.answer.carried)},
        {"too_many",
         report.answer.too_many > question.most ? Json(nullptr) : Json(report.answer.too_many)},
        {"decided", report.answer.is_decided()}}},
      {"levels", Json::array()},
      {"flights", Json::array()},
      {"not_flown", report.not_flown},
      {"settings", report.settings}};
  for (const Answer& answer : uavs_answers(report))
    json["summary"].push_back(answer.lead + answer.rest);
  for (const auto& [level, share] : levels_of(report))
    json["levels"].push_back({{"uavs", level.uavs},
                              {"flights", level.flights},
                              {"reached", level.reached},
                              {"low", share.low},
                              {"high", share.high}});
  for (const UavsPoint& point : report.points)
    for (const campaign::TrialResult& trial : point.trials)
      json["flights"].push_back({{"uavs", point.uavs},
                                 {"seed", trial.seed},
                                 {"reached", trial.outcome == campaign::Outcome::kGoalReached}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tether::report
