// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/output.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace softgauss::io {
namespace {

// In points of the drawing; an A4 page is about as wide.
constexpr double kWidth = 1000.0;
constexpr double kTitle = 46.0;    ///< above all
constexpr double kHeading = 26.0;  ///< above a group
constexpr int kCellsPerRow = 4;
constexpr double kCell = 150.0;
constexpr double kPanel = 210.0;
constexpr std::size_t kMostTogether = 6;  ///< curves in one panel
constexpr int kMostEntries = 1200;        ///< no page shows more

constexpr std::size_t kLongestSubtitle = 150;

// Colours that differ in print and for the colour-blind (Okabe and Ito).
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73",
                                    "#cc79a7", "#e69f00", "#56b4e9"};

/// A text in gnuplot's single quotes.
std::string literal(const std::string& text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("''") : std::string(1, c == '\n' ? ' ' : c);
  return out + "'";
}

std::string withUnit(const CurveGroup& group) {
  return group.unit.empty() ? group.name : fmt::format("{} [{}]", group.name, group.unit);
}

bool isGrid(const CurveGroup& group) {
  return group.curves.size() > kMostTogether ||
         std::any_of(group.curves.begin(), group.curves.end(), [](const Curve& curve) {
           return std::isfinite(curve.lower) || std::isfinite(curve.upper);
         });
}

int gridRows(const CurveGroup& group) {
  return (static_cast<int>(group.curves.size()) + kCellsPerRow - 1) / kCellsPerRow;
}

/// The greatest of 1, 2, 5 times a power of ten that is at most x.
double niceStep(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= x) return digit * power;
  return power;
}

double heightOf(const CurveGroup& group) {
  return kHeading + (isGrid(group) ? gridRows(group) * kCell : kPanel);
}

/// Writes a script panel by panel, from the top down.
class Script {
 public:
  Script(const Recording& recording, const std::vector<CurveGroup>& groups)
      : series_(recording.series().thinned(kMostEntries)) {
    if (!series_.times().empty()) {
      start_ = series_.times().front();
      end_ = std::max(recording.frames().time.back(), start_ + 1e-9);
    }
    height_ = kTitle;
    for (const CurveGroup& group : groups) height_ += heightOf(group);
    writeData(groups);
    begin(recording);
    top_ = kTitle;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (isGrid(groups[i]))
        addGrid(groups[i], fmt::format("$group{}", i));
      else
        addPanel(groups[i], fmt::format("$group{}", i));
      top_ += heightOf(groups[i]);
    }
    line("unset multiplot");
    line("unset output");
  }

  std::string text;

 private:
  template <class... T>
  void line(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<T>(values)...);
    text += '\n';
  }

  void writeData(const std::vector<CurveGroup>& groups) {
    for (std::size_t i = 0; i < groups.size(); ++i) {
      std::vector<std::vector<double>> columns;
      for (const Curve& curve : groups[i].curves) columns.push_back(series_.column(curve.column));
      line("$group{} << END", i);
      for (std::size_t row = 0; row < series_.times().size(); ++row) {
        fmt::format_to(std::back_inserter(text), "{:.9g}", series_.times()[row]);
        for (const std::vector<double>& column : columns)
          text += std::isfinite(column[row]) ? fmt::format(" {:.7g}", column[row]) : " NaN";
        text += '\n';
      }
      line("END");
    }
  }

  void begin(const Recording& recording) {
    line("set terminal svg noenhanced size {},{} font 'Helvetica,11' background '#ffffff'", kWidth,
         height_);
    line("set output '{}'", kGnuplotDrawing);
    line("set datafile missing 'NaN'");
    line("set multiplot");
    line("set border 3 linecolor '#666666'");
    line("set tics nomirror scale 0.5 textcolor '#333333'");
    line("set grid linecolor '#e2e2e2' linetype 1 linewidth 0.5");
    line("set style data lines");
    line("set xrange [{:.9g}:{:.9g}]", start_, end_);
    line("set label 1 {} at screen 0.02,{} font 'Helvetica-Bold,15'",
         literal(recording.model().name), y(18.0));
    std::string subtitle = recording.command;
    if (subtitle.size() > kLongestSubtitle)
      subtitle.replace(kLongestSubtitle, std::string::npos, " …");
    if (!recording.outcome.message.empty()) subtitle = recording.outcome.message;
    line("set label 2 {} at screen 0.02,{} textcolor '{}'", literal(subtitle), y(36.0),
         recording.outcome.message.empty() ? "#666666" : "#c00000");
  }

  double y(double fromTop) const { return 1.0 - fromTop / height_; }

  /// Where the next plot is drawn.
  void place(double left, double top, double width, double height) {
    line("set origin {:.6f},{:.6f}", left / kWidth, y(top + height));
    line("set size {:.6f},{:.6f}", width / kWidth, height / height_);
  }

  /// Sets a range that holds all that is drawn, also where nothing moves. Returns the limits that
  /// are marked, those near their curves.
  std::vector<double> range(const std::vector<Curve>& curves, bool logarithmic) {
    double least = kInfinity, greatest = -kInfinity;
    std::vector<double> marked;
    for (const Curve& curve : curves) {
      double low = kInfinity, high = -kInfinity;
      for (const double value : series_.column(curve.column)) {
        if (!std::isfinite(value) || (logarithmic && value <= 0.0)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
      }
      const NearLimits near(curve, low, high);
      if (near.lower) marked.push_back(curve.lower);
      if (near.upper) marked.push_back(curve.upper);
      least = std::min(least, low);
      greatest = std::max(greatest, high);
    }
    for (const double limit : marked) {
      least = std::min(least, limit);
      greatest = std::max(greatest, limit);
    }
    if (logarithmic) {
      const bool empty = !(greatest > 0.0);
      line("set logscale y; set format y '%.0e'");
      line("set ytics autofreq");
      line("set yrange [{:.6g}:{:.6g}]", empty ? 0.1 : 0.5 * least, empty ? 1.0 : 2.0 * greatest);
      return marked;
    }
    if (least > greatest) least = greatest = 0.0;
    const double pad = greatest - least > 1e-9 * std::max(std::abs(least), std::abs(greatest))
                           ? 0.06 * (greatest - least)
                           : std::max(0.05 * std::abs(greatest), 1e-6);
    line("unset logscale y; set format y '%h'; set ytics {:.9g}",
         niceStep((greatest - least + 2.0 * pad) / 2.5));
    line("set yrange [{:.9g}:{:.9g}]", least - pad, greatest + pad);
    return marked;
  }

  void heading(const CurveGroup& group) {
    line("set label 3 {} at screen 0.02,{} font 'Helvetica-Bold,12'",
         literal(withUnit(group) + " over time [s]"), y(top_ + 14.0));
  }

  void addGrid(const CurveGroup& group, const std::string& data) {
    heading(group);
    line("unset key; set xtics {:.9g}", niceStep((end_ - start_) / 2.5));
    for (std::size_t i = 0; i < group.curves.size(); ++i) {
      const Curve& curve = group.curves[i];
      const int row = static_cast<int>(i) / kCellsPerRow,
                column = static_cast<int>(i) % kCellsPerRow;
      const double width = kWidth / kCellsPerRow;
      place(column * width, top_ + kHeading + row * kCell, width, kCell);
      line("set title {} font 'Helvetica,10' offset 0,-0.8", literal(curve.name));
      line("set lmargin 8; set rmargin 1.5; set tmargin 1.6; set bmargin 1.8");
      std::string limits;
      for (const double limit : range({curve}, group.logarithmic))
        limits += fmt::format(", {:.9g} dashtype 2 linecolor '#c00000' linewidth 0.8", limit);
      line("plot {} using 1:{} linecolor '{}' linewidth 1.3{}", data, i + 2, kColours[0], limits);
      line("unset label 1; unset label 2; unset label 3");
    }
    line("unset title");
  }

  void addPanel(const CurveGroup& group, const std::string& data) {
    heading(group);
    place(0.0, top_ + kHeading, kWidth, kPanel);
    line("set lmargin 8; set rmargin 24; set tmargin 0.5; set bmargin 1.8");
    line("set xtics autofreq; set key at graph 1.02,1 left top Left reverse samplen 2");
    range(group.curves, group.logarithmic);
    std::string curves;
    for (std::size_t i = 0; i < group.curves.size(); ++i)
      curves += fmt::format("{}{} using 1:{} linecolor '{}' linewidth 1.3 title {}",
                            i == 0 ? "" : ", ", data, i + 2, kColours[i % std::size(kColours)],
                            literal(group.curves[i].name));
    line("plot {}", curves);
    line("unset label 1; unset label 2; unset label 3; unset key");
  }

  SeriesTable series_;
  double start_ = 0.0, end_ = 1.0;  // [s]
  double height_ = 0.0;
  double top_ = 0.0;
};

/// "Joint positions" in rad becomes joint_positions_rad.svg.
std::string fileName(const CurveGroup& group) {
  std::string name;
  for (const char c : group.name + " " + (group.unit == "µs" ? "us" : group.unit)) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  if (name.back() == '_') name.pop_back();
  return name + ".svg";
}

}  // namespace

std::string plotScript(const Recording& recording, const std::vector<CurveGroup>& groups) {
  return detail::validUtf8(Script(recording, groups).text);
}

Plot::Plot(const std::filesystem::path& target) : target_(target) {
  std::error_code error;
  const bool isThere = std::filesystem::exists(target, error);
  // A device, a pipe and standard output take the drawing whatever they are called.
  const bool isSpecial =
      isStandardOutput(target) || (isThere && !std::filesystem::is_directory(target, error) &&
                                   !std::filesystem::is_regular_file(target, error));
  const bool isFolder = !isSpecial && (isThere ? std::filesystem::is_directory(target, error)
                                               : !target.has_extension());
  const auto fail = [&](const std::string& problem) {
    throw ModelError({target.string(), 0}, "plot", problem);
  };
  if (!isFolder && !isSpecial && target.extension() != ".svg")
    fail(fmt::format("extension '{}', expected .svg or a folder", target.extension().string()));
  if (!hasGnuplot()) fail(kNoGnuplot);
  if (!isFolder) {
    file_.emplace(target, "plot");
    return;
  }
  std::filesystem::create_directories(target, error);
  if (error) fail("cannot be made: " + error.message());
  detail::expectWritable(target / "plot.svg", "plot");
}

void Plot::write(const Recording& recording) {
  const std::vector<CurveGroup> groups = recording.plots();
  const auto fill = [](detail::OutputFile& file, const std::string& script) {
    file.write(gnuplotDrawing(script));
    file.commit();
  };
  if (file_) return fill(*file_, plotScript(recording, groups));
  for (const CurveGroup& group : groups) {
    detail::OutputFile file(target_ / fileName(group), "plot");
    fill(file, plotScript(recording, {group}));
  }
}

}  // namespace softgauss::io
