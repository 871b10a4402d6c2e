#pragma once

#include "plots/inks.h"

#include <cstddef>
#include <string>
#include <vector>

#include <tether/report/plots.h>

/// Parts of gnuplot scripts.
namespace tether::report {

inline constexpr int kPlotWidth_px = 860;

/// A text as a literal of gnuplot, on one line.
std::string quoted(const std::string& text);

/// Terminal, axes and grid; margins are those of the plotted area.
struct Frame {
  int height_px = 300;
  int left_px = 76;
  int right_px = 24;
  int top_px = 44;  ///< room for the legend above
  int bottom_px = 50;
  int key_rows = 1;
  std::string x_label{};
  std::string y_label{};
};
std::string frame_script(const Frame& frame);

/// "set xrange [low:high]" for `axis` "x" or "y".
std::string range_script(const std::string& axis, double low, double high);

/// A named block of lines of numbers.
class DataBlock {
 public:
  explicit DataBlock(std::string name) : name_(std::move(name)) {}
  /// "$name"
  std::string reference() const { return "$" + name_; }
  void add(double x, double y);
  void add(double x, double y, double dx, double dy);
  /// A line through the points ends here; another one follows.
  void interrupt() { lines_ += "\n"; }

  bool empty() const { return lines_.empty(); }
  std::string script() const;

 private:
  std::string name_;
  std::string lines_;
};

/// The parts of gnuplot's `plot` command, with their data blocks.
class Drawing {
 public:
  /// @param how e.g. "with lines linewidth 2"; @param title empty: not in the legend; @param fill
  /// of closed curves, e.g. "fillstyle solid 0.4".
  void add(const DataBlock& block, const std::string& how, Ink ink, const std::string& title,
           const std::string& fill = "");
  bool empty() const { return parts_.empty(); }
  std::string script() const;

 private:
  std::string blocks_;
  std::vector<std::string> parts_;
};

/// At most `limit` of 0 … count − 1, evenly spaced, the first and the last among them; of one, the
/// middle. @pre limit ≥ 1.
std::vector<std::size_t> thinned(std::size_t count, std::size_t limit);

}  // namespace tether::report
