#include <nlohmann/json.hpp>

#include <tether/report/verdict.h>

// The answers for programs: what a summary says, in members of their own.
namespace tether::report {
namespace {

using Json = nlohmann::ordered_json;
constexpr auto kReplace = Json::error_handler_t::replace;

Json json_of(const ConditionVerdict& condition) {
  const Answer answer = answer_of(condition);
  return {{"condition", condition.condition},
          {"answer", name(condition)},
          {"text", answer.lead + answer.rest},
          {"flights",
           {{"planned", condition.planned},
            {"flown", condition.flown},
            {"reached", condition.reached},
            {"distinct", condition.distinct},
            {"failed", condition.failed}}},
          {"left_out", condition.left_out},
          {"doubtful", condition.doubts_of_answer()}};
}

Json json_of(const std::vector<Verdict>& points) {
  Json json = {{"scenario", points.front().scenario},
               {"answer", name(most_urgent(points).first())},
               {"advice", advice_of(points)},
               {"points", Json::array()}};
  for (const Verdict& point : points) {
    Json one = {{"settings", Json::object()}, {"conditions", Json::array()}};
    for (const campaign::Setting& setting : point.settings)
      one["settings"][setting.key] = setting.value;
    for (const ConditionVerdict& condition : point.conditions)
      one["conditions"].push_back(json_of(condition));
    json["points"].push_back(std::move(one));
  }
  return json;
}

}  // namespace

std::string verdicts_json(const std::vector<Verdict>& verdicts) {
  Json json = Json::array();
  for (const std::vector<Verdict>& points : by_scenario(verdicts)) json.push_back(json_of(points));
  return json.dump(2, ' ', false, kReplace) + "\n";
}

std::string with_answer(const std::string& result_json, const Verdict& verdict) {
  Json json = Json::parse(result_json);
  json["answer"] = json_of(verdict.first());
  json["answer"]["advice"] = advice_of({verdict});
  return json.dump(2, ' ', false, kReplace);
}

}  // namespace tether::report
