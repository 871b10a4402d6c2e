#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/report/table.h>
#include <tether/timing/pace.h>

/// Is this computer fast enough to fly that task? The answer as data, computed here alone, and its
/// words, which terminal, Markdown, pages and JUnit share.
namespace tether::report {

using timing::BoardPace;
using timing::Pace;
using timing::Speed;

/// The share of flights that must reach the goal, as of `tether size`.
inline constexpr double kWantedSuccess = 0.9;

/// The most urgent one first.
enum class Ruling {
  kVoid,             ///< a record breaks the rules of time
  kSetUpFailed,      ///< no flight ran
  kUnseen,           ///< programs waited or computed in ways that Tether does not see
  kNotFastEnough,    ///< fewer than the wanted share reach the goal, or the only flight missed it;
                     ///< and speed is shown to be the reason: see MissReason
  kGoalMissed,       ///< the same, but whether speed is the reason is not known
  kOtherReason,      ///< the same, but speed is probably not the reason
  kNotFlown,         ///< no flight has ended: the campaign was stopped, or still flies
  kUndecided,        ///< the flights show neither
  kFastEnoughSoFar,  ///< every flight reached the goal, but they are too few to be sure
  kFastEnough,       ///< at least the wanted share reach the goal
  kNothingToDecide,  ///< every flight ended well, but the scenario sets no limit
  kFreeRunning,      ///< not synchronised: the flights do not depend on the computer's speed alone
};
/// "not fast enough", …
std::string_view name(Ruling ruling);

/// A limit, a deadline or a goal that flights missed.
struct MissedLimit {
  std::string limit;        ///< "time required ≤ 5 s", "the own goal of uav1's program"
  std::size_t flights = 0;  ///< that missed it
  std::string how{};        ///< of a program's goal, what the first of them said; may be empty
  friend bool operator==(const MissedLimit&, const MissedLimit&) = default;
};
/// The most frequent one first.
using MissedLimits = std::vector<MissedLimit>;
MissedLimits missed_limits(std::span<const campaign::TrialResult* const> trials);
/// If the flight missed nothing but a limit of a metric without a value: why it has none. Else
/// empty.
std::string missed_without_value(const campaign::TrialResult& trial);
/// "time required ≤ 5 s (3 flights), the time limit (1 flight) and 2 more"; of one flight, without
/// the counts.
std::string missed_text(const MissedLimits& missed, bool of_one = false);

/// Why the goal is missed, as far as the flights of all conditions show it.
struct MissReason {
  enum class Evidence {
    // Speed is the reason.
    kFasterReaches,  ///< another condition differs in speed only, is faster, and reaches it
    kMissesOwnPace,  ///< computing alone takes longer than a limit on its pace allows
    // It is not known.
    kNotComparable,      ///< another one reaches it, but differs in more than speed: see `text`
    kOtherSensorsReach,  ///< another one is as fast, has other sensors, and reaches it
    kNothing,            ///< no faster condition was flown, or the speeds are not known
    kFasterUndecided,    ///< another condition is faster, but does not show that speed matters
    kPossibleCause,      ///< something else happened that can be the reason: see `text`
    kBothSidesReach,     ///< a faster and a slower one, which differ in speed only, reach it
    // Speed is probably not the reason.
    kKnownCause,          ///< what happened has nothing to do with computing: see `text`
    kInstant,             ///< computing takes no time under this condition
    kInstantMissesToo,    ///< … under another one, which misses the goal, too
    kFasterMissesToo,     ///< another one is faster, reads every image, and misses it, too
    kEquallyFastReaches,  ///< another one has the same computers and sensors, and reaches it
    kSlowerReaches,       ///< another one differs in speed only, is slower, and reaches it
  };
  Evidence evidence = Evidence::kNothing;
  std::string condition{};         ///< the other one
  std::string text{};              ///< part of a sentence: what happened, or what was compared
  bool is_of_other_build = false;  ///< the other one's programs are for another architecture
  std::size_t reached = 0;         ///< flights of the other one that reached it
};

/// A doubt of campaign::Doubt in the flights of a condition.
struct FlightsInDoubt {
  campaign::Doubt largest{};
  std::size_t flights = 0;
};

/// One condition of a scenario.
struct ConditionVerdict {
  std::string condition;
  Ruling ruling = Ruling::kUndecided;
  std::size_t planned = 0;
  std::size_t flown = 0;    ///< with a result that is no failure
  std::size_t reached = 0;  ///< of these
  /// The same without copies (campaign/copies.h): the evidence.
  std::size_t distinct = 0;
  std::size_t distinct_reached = 0;
  std::size_t failed = 0;        ///< in the set-up or by a lost part: these say nothing
  bool was_interrupted = false;  ///< the user stopped a flight
  std::size_t crashed = 0;
  std::size_t throttled = 0;      ///< the board reduced its clock frequency
  std::size_t without_value = 0;  ///< missed the goal only because a metric has no value
  std::size_t unsound = 0;        ///< audit not passed, or causality violations
  /// The exact interval (Clopper and Pearson, 1934) of the share that reaches the goal, 95 %, from
  /// the distinct flights. None if nothing has flown.
  std::optional<campaign::Interval> share{};
  MissedLimits missed{};
  /// The metric or clause that came closest to its limit in any flight, and how far it was within
  /// it, in shares of the limit.
  std::optional<std::pair<std::string, double>> closest{};
  /// Of the worst ones of each flight, that which is nearest to its limit, on either side: a small
  /// change can change that flight's outcome.
  std::optional<std::pair<std::string, double>> tightest{};
  std::vector<double> margins{};         ///< the worst one of each such flight
  std::string reason{};                  ///< of the first flight that failed, or is not sound
  std::vector<FlightsInDoubt> doubts{};  ///< one of each kind, in the order of the kinds
  /// What of the files is not simulated as written and can change the verdict, one line each.
  std::vector<std::string> left_out{};
  /// What of a flight may be a mistake, one line each; and what of those is so in flights that
  /// reached the goal, where a missed one does not explain it.
  std::vector<std::string> doubtful{}, doubtful_goals{};
  /// Stages that the flights computed for nothing: times are replayed, and have none of them.
  std::vector<std::string> uncharged{};
  std::vector<std::string> varied{};  ///< what differs from flight to flight, as the scenario says
  /// What differs in its build from flight to flight: "the program", "liblaw.so"; empty: nothing.
  std::string mixed_build{};
  std::optional<Pace> pace{};
  std::string unknown_pace{};        ///< why it is not known; empty: there is none to know
  std::optional<MissReason> miss{};  ///< of the three rulings on a missed goal
  /// As in campaign::ThisRun, of the first flight.
  std::optional<campaign::Sizing> sizing{};
  // As far as the first flight says:
  bool is_on_real_board = false;
  bool has_as_is = false;   ///< a program that does not use Tether's library
  std::size_t gave_up = 0;  ///< flights in which such a program ended with a failure

  /// All that has flown is one flight: the only one, or one that was flown several times.
  bool is_one_flight() const { return distinct == 1 && (planned == 1 || flown > 1); }
  bool is_missed() const {
    return ruling == Ruling::kNotFastEnough || ruling == Ruling::kGoalMissed ||
           ruling == Ruling::kOtherReason;
  }
  /// What is doubtful in the flights on which the ruling rests.
  const std::vector<std::string>& doubts_of_answer() const;
  /// None: there is no such doubt.
  const FlightsInDoubt* doubt(campaign::Doubt::Kind kind) const;
};
/// Whether what is in doubt, or this doubt alone, could have moved so many flights over their
/// limits that the ruling would be another one.
bool is_within_spread(const ConditionVerdict& verdict, const FlightsInDoubt& doubt);
bool is_within_spread(const ConditionVerdict& verdict);

/// The ruling's name, or "fast enough in this flight" where all that is known is one flight.
std::string name(const ConditionVerdict& condition);

struct Advice {
  enum class Kind {
    kMendSetUp,
    kFlyAgain,       ///< the user stopped it
    kFlyRest,        ///< the campaign is not complete
    kReadAudit,      ///< subject: the condition
    kShowWaits,      ///< the program waits unseen
    kCountDisk,      ///< it waits for the disk
    kUnstretch,      ///< a factor stretches its waiting
    kRunConcurrent,  ///< its threads compute in parallel
    kRecordAgain,    ///< replayed times are in doubt; subject: their timing file
    kCoolBoard,      ///< subject: the condition
    kSpeedUpStage,   ///< subject: the stage
    kTryFaster,      ///< is it the computer? subject: the condition
    kMendDoubt,      ///< something in the files may not be meant
    kMendProgram,    ///< it ended with a failure of its own
    kFindReason,     ///< it is not the computer; subject: the condition to compare, or empty
    kQuietMachine,   ///< it was busy
    kVarySeeds,      ///< all flights are one
    kFindThreshold,  ///< subject: the condition
    kFlyMore,        ///< subject: the condition; flights: how many in all, 0: very many
    kCompareMore,    ///< a faster condition was flown, too few times; subject: the condition
    kGiveValue,      ///< all that missed the goal did so because a metric has no value
    kSetLimit,
    kSynchronise,
  };
  Kind kind;
  std::string subject{};
  std::size_t flights = 0;
};

struct Verdict {
  std::string scenario;                       ///< without the settings of a sweep
  std::string point{};                        ///< of a sweep: "cpu_factor = 2"
  std::vector<campaign::Setting> settings{};  ///< … as values
  std::vector<ConditionVerdict> conditions;   ///< in the order of the campaign; not empty
  std::size_t lead = 0;          ///< the most urgent condition, with which the answer begins
  std::vector<Advice> advice{};  ///< what to do next; the most useful first

  const ConditionVerdict& first() const { return conditions[lead]; }
};
/// The one whose answer comes first. @pre not empty.
const Verdict& most_urgent(const std::vector<Verdict>& verdicts);

/// Without a reason for missed goals, and without a pace.
ConditionVerdict verdict_of(const campaign::ConditionResults& results);

/// The exact interval of a share, 95 %. @pre flown ≥ 1.
campaign::Interval exact_interval(std::size_t reached, std::size_t flown);

/// Pure. @param paces of each condition, in their order; may be shorter.
/// @pre the scenario has a condition.
Verdict verdict_of(const campaign::ScenarioResults& scenario,
                   const std::vector<std::optional<Pace>>& paces = {});

/// One for each scenario. The pace of a condition is that of the first flight that missed the goal
/// or, if none did, of the first flight.
std::vector<Verdict> verdicts_of(const campaign::CampaignResults& results);

/// The pace of a flight, or why it is not known: one line, empty if there is nothing to know.
struct PaceOrReason {
  std::optional<Pace> pace{};
  std::string unknown{};
};
PaceOrReason pace_or_reason(const campaign::TrialResult& trial);

/// A sentence.
struct Answer {
  std::string lead;                ///< which is to stand out: "Not fast enough"
  std::string rest;                ///< begins with ": " or a space
  std::optional<Ruling> ruling{};  ///< which the lead states; none: it states another fact
};
/// Why no answer can rest on these flights of a condition: programs waited or computed in ways that
/// Tether does not see. None: they did not.
std::optional<Answer> unseen_answer(const std::string& condition,
                                    std::span<const campaign::TrialResult* const> trials);
/// What `tether size` adds to an answer that rests on these flights: what was not simulated, how
/// busy the machine was, what those missed that did not reach the goal, and why no computing times
/// are known (empty: they are).
std::vector<Answer> answers_on_flights(std::span<const campaign::TrialResult* const> trials,
                                       const std::string& unknown_pace);
/// The condition's ruling with its evidence.
Answer answer_of(const ConditionVerdict& condition);
/// The slowest computer of a fleet, over all flights of the condition. None: there are not several.
std::optional<Answer> slowest_board(const ConditionVerdict& condition);
/// The answer, then those on the other conditions. Of a sweep: up to which cpu_factor each
/// condition is fast enough, then one answer for each ruling of a condition.
/// If a condition has several computers, a sentence on the slowest one follows its answer.
/// @pre all are of one scenario; not empty.
std::vector<Answer> answers_of(const std::vector<Verdict>& points);
/// What to do next, with code between backticks. @pre as above.
std::vector<std::string> advice_of(const std::vector<Verdict>& points);

/// What was compared: a row per condition, with the flights, their interval, and the headroom.
Table rulings_table(const std::vector<Verdict>& points);
/// Where the time goes: a row per condition and stage; no rows if it is not known.
Table stages_table(const std::vector<Verdict>& points);
/// … of one condition.
Table stages_table(const std::string& condition, const Pace& pace);

/// The verdicts of each scenario, the points of a sweep together.
std::vector<std::vector<Verdict>> by_scenario(std::vector<Verdict> verdicts);

/// The answer of each scenario in one line, which begins with its name; the most urgent first.
/// Empty for one scenario.
std::vector<Answer> headlines_of(const std::vector<std::vector<Verdict>>& groups);

enum class Markup { kPlain, kMarkdown, kTerminal };  ///< of a terminal: plain, with colours
/// Answers and advice as lines, with a line that is empty at the end.
std::string answer_text(const std::vector<Answer>& answers, const std::vector<std::string>& advice,
                        Markup markup);
/// Answers and advice of all scenarios in the same way.
std::string verdict_text(const std::vector<Verdict>& verdicts, Markup markup);

/// The answers as JSON: an array with an object for each scenario. The member "answer" is a name of
/// a ruling: "fast enough", "doubtful whether fast enough in this flight".
std::string verdicts_json(const std::vector<Verdict>& verdicts);
/// The text of a run's result.json with the answer of its only condition as a member.
std::string with_answer(const std::string& result_json, const Verdict& verdict);

}  // namespace tether::report
