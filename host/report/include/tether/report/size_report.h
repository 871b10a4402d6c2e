#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/result.h>
#include <tether/report/plots.h>
#include <tether/report/table.h>
#include <tether/report/verdict.h>
#include <tether/sizing/sizing.h>

/// What `tether size` found, on its two axes: the answer in sentences, as a drawing, a page and
/// JSON. Pure functions, but for the drawing program of the page.
namespace tether::report {

/// A point of a curve of success over slowdown.
struct CurvePoint {
  double slowdown = 1.0;
  sizing::Share share{};
};
/// The curve over the slowdowns of the question, for drawings.
std::vector<CurvePoint> curve_points(const sizing::SuccessCurve& curve,
                                     const sizing::Question& question);

/// The flights of one condition, at several slowdowns, and what follows from them.
struct SizedCondition {
  std::string condition;
  sizing::Answer answer{};
  std::vector<sizing::Flight> flights{};  ///< one for each trial
  std::vector<campaign::TrialResult> trials{};
  std::vector<CurvePoint> curve{};
  /// Flights that repeated one at the same slowdown (campaign/copies.h). They are not among these.
  std::size_t copies = 0;
};
/// Whether the seeds change nothing: flights differ only where their slowdowns do, so that all of
/// them are one flight at several speeds.
bool is_one_start(const SizedCondition& sized);
/// Adds the flight, or counts it as a copy. @return whether it is one. @pre the trial did not fail.
bool add_flight(SizedCondition& to, const campaign::TrialResult& trial, double slowdown);

/// A computer that the user asks about.
struct Board {
  std::string name;
  double slowdown = 1.0;        ///< relative to the condition
  std::optional<double> low{};  ///< bounds of its calibration; both or none
  std::optional<double> high{};
};
enum class BoardVerdict { kSuffices, kUndecided, kDoesNot };

/// How the search ended, on both axes.
struct SearchOutcome {
  campaign::Settings settings{};
  std::vector<std::string> not_flown{};  ///< one line for each flight that failed, with its reason
  bool is_interrupted = false;           ///< before there was an answer
};

/// What the reports of both axes have.
struct SearchReport : SearchOutcome {
  std::string scenario{};
  std::size_t most_flights = 0;
  PaceOrReason pace{};  ///< of the flight that is nearest to the answer
};

struct SizeReport : SearchReport {
  sizing::Question question{};
  SizedCondition synchronised{};
  /// The same slowdowns and seeds without synchronisation.
  std::optional<SizedCondition> unsynchronised{};
  std::vector<Board> boards{};
};

/// Whether programs waited or computed in ways that Tether does not see, so that there is no
/// answer.
bool has_unseen_time(const SizeReport& report);

/// Whether the answer is as sure as asked, and some slowdown of the question is sufficient.
bool is_answered(const SizeReport& report);

/// A board suffices if all of its interval is within that of sufficient slowdowns.
BoardVerdict verdict(const Board& board, const SizeReport& report);
Answer board_answer(const Board& board, const SizeReport& report);

/// The answer and its evidence: one sentence, after one about slower computers that reach the goal
/// where faster ones fail, if there are any; then one for each board, then what limits the answer.
std::vector<Answer> size_answers(const SizeReport& report);

/// What to do next; each one sentence.
std::vector<std::string> size_advice(const SizeReport& report);
/// The pace of the flight whose slowdown is nearest to the answer.
PaceOrReason pace_near_answer(const SizeReport& report);

/// Success over slowdown with the flights and the boards, and below it the margin of each limited
/// metric.
Plot size_plot(const SizeReport& report);

/// A metric's distance from its limit in shares of the limit, negative beyond it. None without a
/// value or a limit, and for counts, which do not vary continuously.
std::optional<double> margin_of(const campaign::MetricValue& metric);
/// The same of a clause.
std::optional<double> margin_of(const judge::ClauseVerdict& clause);
/// Whether the flights at low slowdowns reach the goal more often than those at high ones, which
/// chance does not explain.
bool speed_matters(const SizedCondition& sized);

/// The flight for the statistics. Its margin is that of its worst metric, if that agrees with the
/// outcome. @pre the trial did not fail.
sizing::Flight flight_of(const campaign::TrialResult& trial, double slowdown);

/// The flights with the first so many UAVs of the scenario; none of them failed.
struct UavsPoint {
  sizing::UavLevel level{};  ///< without copies
  std::vector<campaign::TrialResult> trials{};
};

/// Its pace is of a flight with the fewest UAVs that are too many or, if there are none, with the
/// most that were flown.
struct UavsReport : SearchReport {
  std::string named{};  ///< the scenario for a command line (scenario::ShippedFiles::name_of)
  std::string condition{};
  std::string board{};  ///< name of the target that the UAVs share
  int cores = 1;        ///< of the board
  sizing::UavQuestion question{};
  sizing::UavAnswer answer{};
  std::vector<UavsPoint> points{};  ///< in ascending order
};

/// @return whether the flight is a copy of an earlier one, which does not count. @pre the trial did
///   not fail.
bool add_flight(UavsPoint& to, const campaign::TrialResult& trial);

/// Those that were flown, in ascending order.
std::vector<sizing::UavLevel> uav_levels(const std::vector<UavsPoint>& points);
PaceOrReason pace_at_limit(const UavsReport& report);
std::size_t flights_of(const UavsReport& report);
/// Of these, copies of other ones with as many UAVs, which do not count.
std::size_t copies_in(const UavsReport& report);

/// Whether the number of UAVs is known, and at least the least one that was asked for.
bool is_answered(const UavsReport& report);
/// The answer with its evidence, then what limits it.
std::vector<Answer> uavs_answers(const UavsReport& report);
/// What to do next; each one sentence.
std::vector<std::string> uavs_advice(const UavsReport& report);
/// The share of flights that reach the goal over the number of UAVs, with exact intervals.
Plot uavs_plot(const UavsReport& report);

inline constexpr int kSizeSchemaVersion = 1;
/// The content of `size.json` (docs/guide/size.md).
std::string size_json(const SizeReport& report);
std::string size_json(const UavsReport& report);

/// An answer of `tether size`, whatever it varied: what the terminal shows, the page and JUnit.
struct SizeAnswer {
  struct OfBoard {
    std::string board;
    bool suffices = false;
    Answer answer{};
  };

  std::string scenario{}, condition{};
  std::string question{};  ///< "how slow a computer is fast enough?"
  std::vector<Answer> answers{};
  std::vector<std::string> advice{};
  bool is_answered = false;
  std::vector<OfBoard> boards{};
  Plot plot{};
  std::string caption{};
  std::vector<Table> tables{};    ///< below the drawing
  std::optional<Table> levels{};  ///< folded
  Table basis{};
  std::vector<std::string> not_flown{};
  std::vector<const campaign::TrialResult*> trials{};
  std::string json{};
};
/// @pre the report outlives the answer.
SizeAnswer size_answer(const SizeReport& report);
SizeAnswer size_answer(const UavsReport& report);
/// One self-contained page: answer, drawing, tables.
/// @throws Error(kSetup) if gnuplot is missing or fails.
std::string size_page(const SizeAnswer& answer);

}  // namespace tether::report
