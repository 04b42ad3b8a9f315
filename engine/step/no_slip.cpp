// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/no_slip.hpp"

#include "softgauss/engine/step/gauss_objective.hpp"

namespace softgauss {
namespace {

/// All constraints, with the contacts' bounded friction in place of the contacts.
class BoundedFriction {
 public:
  BoundedFriction(Constraints& constraints, NoSlipFriction& friction)
      : constraints_(constraints), friction_(friction) {}

  const TreeSparsity& sparsity() const { return constraints_.sparsity(); }
  void setResidual(const VectorX& a) {
    const auto set = [&](auto& c) {
      c.multiply(a, c.x);
      for (std::size_t i = 0; i < c.x.size(); ++i) c.x[i] -= c.reference[i];
    };
    constraints_.visitAllButContacts(set);
    set(friction_);
  }
  void setRay(const VectorX& d) {
    constraints_.visitAllButContacts([&](auto& c) { c.multiply(d, c.dx); });
    friction_.multiply(d, friction_.dx);
  }
  double evaluate(bool& cellChanged) {
    double cost = friction_.evaluate(cellChanged);
    constraints_.visitAllButContacts([&](auto& c) { cost += c.evaluate(cellChanged); });
    return cost;
  }
  void along(double alpha, Jet& jet) const {
    constraints_.visitAllButContacts([&](const auto& c) { c.along(alpha, jet); });
    friction_.along(alpha, jet);
  }
  bool staysInCell() const { return false; }  // its cones bend
  void advance(double alpha) {
    constraints_.visitAllButContacts([&](auto& c) { c.advance(alpha); });
    friction_.advance(alpha);
  }
  void addForce(VectorX& tau) const {
    constraints_.visitAllButContacts([&](const auto& c) { c.addTransposed(c.f, tau); });
    friction_.addForce(tau);
  }
  void addCurvature(TreeMatrix& P) {
    constraints_.visitAllButContacts([&](auto& c) { c.addCurvature(P); });
    friction_.addCurvature(P);
  }

 private:
  Constraints& constraints_;
  NoSlipFriction& friction_;
};

}  // namespace

void removeSlip(const Model& model, Data& data) noexcept {
  ForwardSolution& s = data.forward;
  Constraints& constraints = data.constraints;
  if (!data.noSlipFriction.take(constraints.contact, constraints.ellipticContact, s.a)) return;
  BoundedFriction rows(constraints, data.noSlipFriction);
  GaussObjective objective(data.inertia, data.forces.net, rows, s);
  s.start = s.a;  // moveTo() writes s.a
  objective.moveTo(s.start);
  const NewtonReport first = s.report;
  s.cellFactored = false;  // `factor` becomes that of the second problem
  s.report = minimize(objective, model.options.tolerance, model.options.maxIterations, s.gradient,
                      s.direction);
  if (s.report.status != SolveStatus::converged) {
    // The first solution is a solution of the soft problem: this step creeps.
    data.noSlipFriction.clear();
    bool changed = false;
    s.a = s.start;
    constraints.setResidual(s.a);
    constraints.evaluate(changed);
    s.report.status = first.status;
    s.report.residual = first.residual;
    ++data.stats.noSlipFallbacks;
  }
  s.report.iterations += first.iterations;
  s.report.factorizations += first.factorizations;
  s.report.lineSearchEvaluations += first.lineSearchEvaluations;
}

}  // namespace softgauss
