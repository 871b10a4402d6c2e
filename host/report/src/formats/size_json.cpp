#include <array>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>

#include <tether/report/size_report.h>

namespace tether::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 3> kBases = {"margins", "curve", "levels"};
constexpr std::array<std::string_view, 3> kVerdicts = {"sufficient", "undecided", "not_sufficient"};

Json known_bound(double bound) {
  return bound > 0.0 && std::isfinite(bound) ? Json(bound) : Json(nullptr);
}

Json json_of(const sizing::Answer& answer) {
  return {{"threshold", answer.threshold.estimate},
          {"low", known_bound(answer.threshold.low)},
          {"high", known_bound(answer.threshold.high)},
          {"where", answer.is_below   ? "below"
                    : answer.is_above ? "above"
                                      : "within"},
          {"narrow", answer.is_narrow},
          {"basis", kBases[static_cast<std::size_t>(answer.basis)]},
          {"fit", answer.fit}};
}

Json flight_json(const sizing::Flight& flight, const campaign::TrialResult& trial) {
  Json metrics = Json::object();
  for (const campaign::MetricValue& metric : trial.metrics)
    metrics[metric.name] = metric.value ? Json(*metric.value) : Json(nullptr);
  return {{"slowdown", flight.slowdown},
          {"seed", trial.seed},
          {"reached", flight.reached},
          {"margin", flight.margin ? Json(*flight.margin) : Json(nullptr)},
          {"metrics", metrics}};
}

Json json_of(const SizedCondition& sized) {
  Json json = {{"condition", sized.condition},
               {"answer", json_of(sized.answer)},
               {"copies", sized.copies},
               {"curve", Json::array()},
               {"flights", Json::array()}};
  for (const CurvePoint& point : sized.curve)
    json["curve"].push_back({{"slowdown", point.slowdown},
                             {"success", point.share.estimate},
                             {"low", point.share.low},
                             {"high", point.share.high}});
  for (std::size_t i = 0; i < sized.flights.size(); ++i)
    json["flights"].push_back(flight_json(sized.flights[i], sized.trials[i]));
  return json;
}

Json json_of(const Board& board, const SizeReport& report) {
  Json json = {{"name", board.name},
               {"slowdown", board.slowdown},
               {"headroom", report.synchronised.answer.threshold.estimate / board.slowdown},
               {"verdict", kVerdicts[static_cast<std::size_t>(verdict(board, report))]}};
  if (board.low) json["calibration"] = {*board.low, *board.high};
  return json;
}

Json summary_of(const std::vector<Answer>& answers) {
  Json summary = Json::array();
  for (const Answer& answer : answers) summary.push_back(answer.lead + answer.rest);
  return summary;
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string size_json(const SizeReport& report) {
  const sizing::Question& question = report.question;
  Json json = {{"schema", kSizeSchemaVersion},
               {"scenario", report.scenario},
               {"summary", summary_of(size_answers(report))},
               {"question",
                {{"success", question.success},
                 {"confidence", question.confidence},
                 {"interval", question.interval},
                 {"between", {question.least, question.most}},
                 {"max_trials", report.most_flights}}}};
  json.update(json_of(report.synchronised));
  json["boards"] = Json::array();
  for (const Board& board : report.boards) json["boards"].push_back(json_of(board, report));
  if (report.unsynchronised) json["unsynchronised"] = json_of(*report.unsynchronised);
  json["interrupted"] = report.is_interrupted;
  json["not_flown"] = report.not_flown;
  json["settings"] = report.settings;
  return text_of(json);
}

std::string size_json(const UavsReport& report) {
  const sizing::UavQuestion& question = report.question;
  Json json = {
      {"schema", kSizeSchemaVersion},
      {"axis", "uavs"},
      {"scenario", report.scenario},
      {"condition", report.condition},
      {"board", {{"name", report.board}, {"cores", report.cores}}},
      {"summary", summary_of(uavs_answers(report))},
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
      {"interrupted", report.is_interrupted},
      {"not_flown", report.not_flown},
      {"settings", report.settings}};
  for (const sizing::UavLevel& level : uav_levels(report.points)) {
    const sizing::Share share = level.share(question.confidence);
    json["levels"].push_back({{"uavs", level.uavs},
                              {"flights", level.flights},
                              {"reached", level.reached},
                              {"low", share.low},
                              {"high", share.high}});
  }
  for (const UavsPoint& point : report.points)
    for (const campaign::TrialResult& trial : point.trials)
      json["flights"].push_back({{"uavs", point.level.uavs},
                                 {"seed", trial.seed},
                                 {"reached", trial.outcome == campaign::Outcome::kGoalReached}});
  return text_of(json);
}

}  // namespace tether::report
