#include "plots/plot_script.h"

#include <cmath>

#include <fmt/format.h>

namespace tether::report {
namespace {

constexpr double kXLabel_px = 13.0, kYLabel_px = 14.0;  // from the drawing's edge

// Seven digits: 0.1 ms of a run of 100 s, and less than a pixel of anything.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : "NaN";
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string literal = "'";
  for (const char c : text) {
    if (c == '\'') literal += '\'';
    literal += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return literal + "'";
}

std::string frame_script(const Frame& frame) {
  const std::string foreground = gnuplot_colour(Ink::kForeground);
  const double width = kPlotWidth_px, height = frame.height_px;
  return fmt::format(
      "set encoding utf8\n"
      "set terminal svg size {0},{1} fixed noenhanced font 'sans-serif,14' linewidth 1 name 'p'\n"
      "set lmargin at screen {2:.5f}\nset rmargin at screen {3:.5f}\n"
      "set tmargin at screen {4:.5f}\nset bmargin at screen {5:.5f}\n"
      "set border 3 linecolor {6}\nset tics nomirror out scale 0.6 textcolor {6}\n"
      "set grid linecolor {7} linewidth 0.6 dashtype solid\n"
      "set xtics offset 0,0.4\n"
      "set key at screen {3:.5f}, screen 0.995 right top horizontal noenhanced samplen 2 "
      "maxrows {8} textcolor {6}\n"
      "set label {9} at graph 0.5, screen {10:.5f} center textcolor {6}\n"
      "set label {11} at screen {12:.5f}, graph 0.5 center rotate textcolor {6}\n",
      kPlotWidth_px, frame.height_px, frame.left_px / width, 1.0 - frame.right_px / width,
      1.0 - frame.top_px / height, frame.bottom_px / height, foreground,
      gnuplot_colour(Ink::kMuted), frame.key_rows, quoted(frame.x_label), kXLabel_px / height,
      quoted(frame.y_label), kYLabel_px / width);
}

std::string range_script(const std::string& axis, double low, double high) {
  return fmt::format("set {}range [{}:{}]\n", axis, number(low), number(high));
}

void DataBlock::add(double x, double y) {
  lines_ += number(x) + " " + number(y) + "\n";
}

void DataBlock::add(double x, double y, double dx, double dy) {
  lines_ += number(x) + " " + number(y) + " " + number(dx) + " " + number(dy) + "\n";
}

std::string DataBlock::script() const {
  return fmt::format("${} << END\n{}END\n", name_, lines_);
}

void Drawing::add(const DataBlock& block, const std::string& how, Ink ink, const std::string& title,
                  const std::string& fill) {
  if (block.empty()) return;
  blocks_ += block.script();
  parts_.push_back(fmt::format("{} {} linecolor {} {} {}", block.reference(), how,
                               gnuplot_colour(ink), fill,
                               title.empty() ? "notitle" : "title " + quoted(title)));
}

std::string Drawing::script() const {
  return fmt::format("{}plot {}\n", blocks_, fmt::join(parts_, ", \\\n     "));
}

std::vector<std::size_t> thinned(std::size_t count, std::size_t limit) {
  std::vector<std::size_t> kept;
  if (limit == 1 && count > 1) return {count / 2};
  if (count <= limit) {
    for (std::size_t i = 0; i < count; ++i) kept.push_back(i);
  } else {
    for (std::size_t i = 0; i < limit; ++i) kept.push_back(i * (count - 1) / (limit - 1));
  }
  return kept;
}

}  // namespace tether::report
