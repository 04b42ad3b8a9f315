// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/kink_picture.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "softgauss/gdd/cell_response.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace softgauss::app {
namespace {

constexpr int kHalf = 50;            ///< points on either side of the minimum
constexpr double kLength = 0.5;      ///< of either side [N m]
constexpr double kProbe = 1e-3;      ///< of the slopes at the minimum [N m]
constexpr double kAtKnot = 1e-6;     ///< |x| of a row at its breakpoint, rounding above it [m/s²]
constexpr double kFromBound = 1e-9;  ///< controls nearer to a bound are at it [N m]

/// A line of controls u + t p.
struct Line {
  std::vector<double> t, F, x, force;  ///< [N m], [N m/s²], [m/s²], [N]
};

struct Kink {
  const Record* record = nullptr;
  VectorX control;        ///< at the minimum (nv)
  Breakpoint breakpoint;  ///< the row at it
  int contact = 0;        ///< of that row, index into ContactSet::contacts
  VectorX across, along;
  double below = 0.0, above = 0.0;  ///< slopes up from the minimum, across the breakpoint
};

class KinkFinder {
 public:
  KinkFinder(const Robot& robot, const Dataset& dataset)
      : robot_(robot),
        model_(robot.model),
        dataset_(dataset),
        data_(model_),
        cost_(model_.nv),
        limits_(model_),
        solver_(model_) {}

  Kink sharpest() {
    Kink best;
    for (const Record& record : dataset_.records) {
      if (record.status != gdd::GddStatus::nonsmoothMinimum) continue;
      const std::optional<Kink> kink = kinkOf(record);
      if (kink && std::min(kink->below, kink->above) > std::min(best.below, best.above))
        best = *kink;
    }
    if (!best.record)
      throw std::runtime_error(
          "no record has its minimum at the breakpoint of one row of a contact");
    pose(*best.record);
    return best;
  }

  /// Of the kink that was found last.
  Line line(const Kink& kink, const VectorX& p) {
    Line line;
    const double F = objective(kink.control);
    for (int i = -kHalf; i <= kHalf; ++i) {
      const double t = kLength * i / kHalf;
      line.t.push_back(t);
      line.F.push_back(objective(kink.control + t * p) - F);
      const double x = data_.constraints.aboveBreakpoint(kink.breakpoint);
      line.x.push_back(x);
      line.force.push_back(data_.constraints.curvatureJump(kink.breakpoint) * std::min(x, 0.0));
    }
    return line;
  }

  std::string contactName(const Kink& kink) const {
    const Contact& contact = data_.contacts.contacts[kink.contact];
    return fmt::format("{} on {}", model_.geometries[contact.geometryB].name,
                       model_.geometries[contact.geometryA].name);
  }

 private:
  void pose(const Record& record) {
    computeStages(model_, robot_.input, record.state, data_, robot_.contacts.get());
    poseProblem(dataset_.goals[record.goal], {model_, record.state, data_}, cost_);
    guess_ = record.acceleration;
    if (!massFactor_.compute(data_.inertia.M))
      throw std::runtime_error("M is not positive definite");
  }

  std::optional<Kink> kinkOf(const Record& record) {
    pose(record);
    WarmStart warm;
    warm.gddA = record.acceleration;
    warm.control = record.control;
    warm.gddValid = true;
    const gdd::GddReport report = solver_.solve(model_, cost_, limits_, data_, warm);
    if (report.status != gdd::GddStatus::nonsmoothMinimum || report.heldRows != 1) return {};
    Kink kink;
    kink.record = &record;
    kink.control = solver_.force();
    if (!findRow(kink) || !findDirections(kink)) return {};
    // F is quadratic on either side, so these are the slopes to rounding.
    const double F = objective(kink.control);
    const auto slope = [&](double t) {
      const double one = objective(kink.control + t * kink.across) - F;
      const double two = objective(kink.control + 2.0 * t * kink.across) - F;
      return (4.0 * one - two) / (2.0 * std::abs(t));
    };
    kink.below = slope(-kProbe);
    kink.above = slope(kProbe);
    return kink;
  }

  /// The one row of a contact that is at its breakpoint.
  bool findRow(Kink& kink) const {
    const PyramidalContact& contact = data_.constraints.contact;
    constexpr int kPlace = static_cast<int>(RowKind::pyramid);
    int found = 0;
    for (const ContactRows& made : contact.contactsWithRows())
      for (int i = made.row; i < made.row + std::max(1, 2 * made.frictionDim); ++i) {
        if (std::abs(contact.x[i]) > kAtKnot) continue;
        kink.breakpoint = {{kPlace, i}, 0};
        kink.contact = made.contact;
        ++found;
      }
    return found == 1;
  }

  /// Of the controls that are not at a bound.
  bool findDirections(Kink& kink) {
    data_.constraints.enterPiece(kink.breakpoint, true);  // rounding must not choose
    cell_.setDriven(model_, limits_, data_.active.dofs());
    if (!cell_.setInertia(data_, cost_) || !cell_.enter(data_)) return false;
    cell_.computeHessian();
    VectorX J(model_.nv), n, u, lower, upper;
    data_.constraints.breakpointGradient(kink.breakpoint, J);
    cell_.solve(J);
    cell_.select(J, n);
    cell_.select(kink.control, u);
    cell_.select(limits_.lower, lower);
    cell_.select(limits_.upper, upper);
    MatrixX K = cell_.hessian().selfadjointView<Eigen::Lower>();
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      if (u[i] > lower[i] + kFromBound && u[i] < upper[i] - kFromBound) continue;
      n[i] = u[i] = 0.0;
      K.row(i).setZero();
      K.col(i).setZero();
      K(i, i) = 1.0;
    }
    const VectorX p = K.llt().solve(n).normalized();
    const VectorX q = (u - n.dot(u) / n.squaredNorm() * n).normalized();
    kink.across = kink.along = VectorX::Zero(model_.nv);
    cell_.spread(p, kink.across);
    cell_.spread(q, kink.along);
    return kink.across.allFinite() && kink.along.allFinite();
  }

  /// F(u), and the rows as they are there.
  double objective(const VectorX& control) {
    setAppliedForce(control, data_.forces);
    if (forwardDynamics(model_, &guess_, data_) == SolveStatus::notFinite)
      throw std::runtime_error("forward dynamics became non-finite");
    bool changed = false;
    data_.constraints.setResidual(data_.forward.a);
    data_.constraints.evaluate(changed);
    cost_.controlCost().multiply(massFactor_, control, controlCost_);
    data_.inertia.M.multiply(data_.forward.a, Ma_);
    return 0.5 * control.dot(controlCost_) + cost_.value(data_.forward.a, Ma_);
  }

  const Robot& robot_;
  const Model& model_;
  const Dataset& dataset_;
  Data data_;
  gdd::GoalCost cost_;
  const gdd::ControlLimits limits_;
  gdd::ActiveSet solver_;
  gdd::CellResponse cell_;
  TreeFactor massFactor_;
  VectorX guess_, controlCost_, Ma_{VectorX::Zero(model_.nv)};
};

/// Of two to five tics in a range: 1, 2 or 5 times a power of ten.
double ticStep(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 2.5)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= range / 2.5) return digit * power;
  return power;
}

std::string script(const std::array<Line, 2>& lines, const std::string& title) {
  std::string text;
  const auto add = [&](const std::string& line) { text += line + "\n"; };
  for (std::size_t k = 0; k < lines.size(); ++k) {
    add(fmt::format("$line{} << END", k));
    for (std::size_t i = 0; i < lines[k].t.size(); ++i)
      add(fmt::format("{:.6g} {:.7g} {:.7g} {:.7g}", lines[k].t[i], lines[k].F[i], lines[k].x[i],
                      lines[k].force[i]));
    add("END");
  }
  add("set terminal svg noenhanced size 900,660 font 'Helvetica,12' background '#ffffff'");
  add(fmt::format("set output '{}'", io::kGnuplotDrawing));
  add(fmt::format("set multiplot title '{}' font 'Helvetica-Bold,13'", title));
  add("set border 3 linecolor '#666666'");
  add("set tics nomirror scale 0.5 textcolor '#333333'");
  add("set grid linecolor '#e2e2e2' linetype 1 linewidth 0.5");
  add("unset key; set style data lines");
  add(fmt::format("set xrange [{}:{}]", -kLength, kLength));
  add("set lmargin 10; set rmargin 2; set tmargin 1.5; set bmargin 2.5");
  const std::array<const char*, 2> heads = {"across the breakpoint",
                                            "along it, F magnified 50 times"};
  const std::array<const char*, 3> names = {"F less its minimum [N m/s²]", "x of the row [m/s²]",
                                            "force of the row [N]"};
  const std::array<const char*, 3> colours = {"#0072b2", "#009e73", "#d55e00"};
  const std::array<double, 3> bottoms = {0.52, 0.28, 0.0}, heights = {0.41, 0.25, 0.28};
  for (std::size_t row = 0; row < names.size(); ++row) {
    double least = 0.0, greatest = 0.0;  // both columns have the scale of the first
    for (const double y : row == 0 ? lines[0].F : row == 1 ? lines[0].x : lines[0].force) {
      least = std::min(least, y);
      greatest = std::max(greatest, y);
    }
    const double pad = 0.08 * (greatest - least);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const double scale = row == 0 && k == 1 ? 0.02 : 1.0;
      add(fmt::format("set yrange [{:.6g}:{:.6g}]; set ytics {:g}", scale * (least - pad),
                      scale * (greatest + pad), scale * ticStep(greatest - least)));
      add(fmt::format("set origin {},{}; set size 0.5,{}", 0.5 * static_cast<double>(k),
                      bottoms[row], heights[row]));
      add(row == 0 ? fmt::format("set title '{}'", heads[k]) : "unset title");
      add(k == 0 ? fmt::format("set ylabel '{}'", names[row]) : "unset ylabel");
      add(row == 2 ? "set bmargin 4; set xlabel 'change of the control, t [N m]'" : "unset xlabel");
      add(fmt::format("plot $line{} using 1:{} linecolor '{}' linewidth 1.8", k, row + 2,
                      colours[row]));
    }
  }
  add("unset multiplot");
  add("unset output");
  return text;
}

}  // namespace

void drawKink(const Robot& robot, const Dataset& dataset, const std::filesystem::path& file) {
  KinkFinder finder(robot, dataset);
  const Kink kink = finder.sharpest();
  const std::array<Line, 2> lines = {finder.line(kink, kink.across), finder.line(kink, kink.along)};
  const std::string title =
      fmt::format("{}, goal weight {:g} kg, t = {:.3f} s: an edge of the contact {}", robot.name,
                  dataset.weight, kink.record->state.time, finder.contactName(kink));
  fmt::print(
      "{}\n  slopes up from the minimum: {:.4g} towards the stiff side, {:.4g} towards the free "
      "side\n",
      title, kink.below, kink.above);
  std::ofstream out(file);
  if (!(out << io::gnuplotDrawing(script(lines, title)) << std::flush))
    throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace softgauss::app
