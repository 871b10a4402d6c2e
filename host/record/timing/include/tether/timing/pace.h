#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/time.h>
#include <tether/record/reader.h>
#include <tether/timing/timing.h>

namespace tether::timing {

/// What one of the computers of a fleet contributed to a run.
struct BoardPace {
  std::string board;                ///< its name in the scenario
  std::vector<std::string> uavs{};  ///< in the record's order
  /// Of the UAV on it whose images cost most, as in Pace. 0: none reads images.
  double median_s = 0.0;
  double p95_s = 0.0;
  /// The share of wall time in which programs of no other computer computed: all others were held,
  /// or had finished. None: not measured.
  std::optional<double> alone{};

  // Over several flights, the above are means.
  std::size_t flights = 1;
  std::size_t slowest_in = 0;               ///< flights in which it was the slowest
  std::pair<double, double> p95_range_s{};  ///< least and largest of a flight
  std::pair<double, double> alone_range{};

  friend bool operator==(const BoardPace&, const BoardPace&) = default;
};

/// What decides how fast the programs of a run compute: equal for runs on the same computers.
struct Speed {
  struct Program {
    std::string uav{};
    computer::Clock clock{};
    std::optional<record::ReplayInfo> replay{};   ///< of a replayed clock
    std::string board{}, computer{}, launcher{};  ///< as in record::SutInfo
    bool concurrent = false;
    std::string build{};  ///< of the program and the files that it was given; empty: not known
    std::vector<std::string> libraries{};  ///< with their builds, in the order of their names
    std::string loader{};  ///< of its libraries, which differs between architectures
    std::optional<int> pinned_core{};
    double idle_W = 0.0, busy_core_W = 0.0;  ///< of the computer; 0: energy is not simulated
    int cores = 0;  ///< of this machine, to which it is bound; 0: all, or not known from a record
    friend bool operator==(const Program&, const Program&) = default;
  };
  std::vector<Program> programs{};  ///< in the record's order
  std::vector<record::BoardInfo> boards{};
  std::string machine{};  ///< empty: of a repeatable run, in which it does not matter
  std::string target{};   ///< its name and address
  record::EmulatorInfo emulator{};
  friend bool operator==(const Speed&, const Speed&) = default;

  /// Whether the scenario sets how long each program computes.
  bool is_scripted() const;
  /// … to next to nothing, as on an infinitely fast computer: at most 0.01 ms for each phase.
  bool is_instant() const;
  /// Whether times between calls contain what a program waits in between, which no computer
  /// shortens.
  bool measures_waits() const;
  /// Whether a factor makes more of what a program waits between its calls, and nobody measures how
  /// much that is: of a concurrent program, some threads may wait while others compute.
  bool stretches_unseen_waits() const;
};

/// How fast the program of one run worked, and on what it spent its computing time.
struct Pace {
  std::string uav{};
  std::uint64_t seed = 0;
  std::vector<StageRow> stages{};  ///< the largest share first

  // Of the camera that was read most often. If none was read twice: empty, 0 and none.
  std::string camera{};
  std::size_t images = 0;
  double read_hz = 0.0;                ///< one over the median ST between two images
  std::optional<double> offered_hz{};  ///< none if the camera has no rate of its own
  /// Cost of an image: computing between two images and, on a shared board, waiting for its cores.
  double median_s = 0.0;
  double p95_s = 0.0;  ///< of 95 % of the images
  /// Share of the time between the first image and the last in which images came late because
  /// computing took longer than the camera's period. A median says nothing of a short, slow phase.
  double behind = 0.0;
  double reading = 1.0;  ///< share of the flight between the first image and the last

  /// Several programs share a real board: times include waiting for its cores, which is not known.
  bool shares_real_board = false;
  // Of a modelled board that several programs share. Otherwise: empty, 0 and 0.
  std::string shared_board{};
  std::size_t programs = 0;  ///< that share its cores, this one among them
  double waiting = 0.0;      ///< share of the cost of all images: others had the cores

  /// Of a fleet with several computers; empty: of no such fleet, or not known.
  std::vector<BoardPace> boards{};

  /// Set-points that the program sent by MAVLink, one over the median time between two; 0: none.
  double setpoint_hz = 0.0;
  double setpoint_gap_s = 0.0;  ///< the longest time until the next, or to the end of the flight
  /// Of all programs, while they ran: how often a flight controller waited too long for the next
  /// set-point, and did something else than to go on.
  struct Losses {
    std::size_t count = 0;
    SimTime first_at{};
    std::string uav{}, action{};  ///< of the first one: what it does, "hover", "brake" or "land"
    friend bool operator==(const Losses&, const Losses&) = default;
    /// After the UAV's name: "had no new set-point for too long once, at ST 3.201 s, and …".
    std::string text() const;
  } losses{};

  /// Of all programs: measurements that had no place in the queue of their sensor, because it was
  /// read too seldom. A record does not have them: `pace_of` leaves this empty.
  struct Unqueued {
    std::string uav{}, sensor{};
    std::uint64_t count = 0;
    friend bool operator==(const Unqueued&, const Unqueued&) = default;
  };
  std::vector<Unqueued> unqueued{};
  /// Why it is not known whether a program computed all of its times or waited, for a person;
  /// empty: it is. Left empty by `pace_of`, too.
  std::string unclear{};

  Speed speed{};             ///< of all programs of the run
  std::string radio{};       ///< its settings, to compare them; empty: there is none
  std::size_t messages = 0;  ///< of all programs, once for each receiver
  std::size_t messages_arrived = 0;

  /// How many times slower the program could compute, and still 95 % of its images would take no
  /// longer than the camera's period. None without a camera with a rate.
  std::optional<double> headroom() const;
  /// Whether the program reads (nearly) every image that the camera offers: in the median.
  bool reads_nearly_every() const;
  /// … and (nearly) all the time.
  bool keeps_up() const;
  /// Whether it reads fewer images, because computing one takes longer than the camera's period.
  bool is_too_slow_for_camera() const;

  friend bool operator==(const Pace&, const Pace&) = default;
};

/// Of the SUT whose images cost most. None if the run was not synchronised (its computing
/// times are not known), or has no interactions.
std::optional<Pace> pace_of(const record::Record& record);

}  // namespace tether::timing
