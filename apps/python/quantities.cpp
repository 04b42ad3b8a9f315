// SPDX-License-Identifier: Apache-2.0
/// Simulation: what a state has, and how dynamics and a step change with it.

#include "apps/python/at_state.hpp"
#include "apps/python/held.hpp"
#include "apps/python/stages.hpp"
#include "softgauss/engine/dynamics/energy.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "softgauss/engine/step/forward_derivative.hpp"

namespace softgauss::python {
namespace {

VectorX biasForces(const Posed& at) {
  MassMatrix inertia(at.model);
  computeMassMatrix(at.model, at.k, inertia);
  RneaWorkspace work(at.model);
  VectorX bias(at.model.nv);
  computeBias(at.model, at.k, inertia, work, bias);
  return bias;
}

py::tuple energy(const Posed& at) {
  const Energy e = computeEnergy(at.model, at.k, at.state.q, at.state.v);
  return py::make_tuple(e.kinetic, e.potential);
}

/// Linear, and angular about the centre of mass.
Vector6 momentum(const Posed& at) {
  const Momentum m = computeMomentum(at.model, at.k);
  Vector6 both;
  both << m.linear, m.angular - centerOfMass(at.model, at.k).cross(m.linear);
  return both;
}

/// Of a point of a link, then of the link's rotation.
using LinkMotion = Vector6 (*)(const Posed& at, int body, const Vector3& p_WP);

Vector6 velocityOf(const Posed& at, int body, const Vector3& p_WP) {
  Vector6 both;
  both << pointVelocity(at.model, at.k, body, p_WP), at.k.V[idx(body)].angular;
  return both;
}

Vector6 biasAccelerationOf(const Posed& at, int body, const Vector3& p_WP) {
  Vector6 both;
  both << pointBiasAcceleration(at.model, at.k, body, p_WP), at.k.A_bias[idx(body)].angular;
  return both;
}

auto ofLink(const char* what, LinkMotion motion) {
  return [=](Held& held, const std::string& link, const py::object& point, const py::object& q,
             const py::object& v) {
    return held.alone([&](Simulation& sim) -> VectorX {
      const Frame& frame = frameOf(sim.model(), link, what);
      const Posed at(sim, q, v);
      return motion(at, frame.body, at.placeOf(frame, point));
    });
  };
}

RowMajorMatrixX centerOfMassJacobian(const Posed& at) {
  RowMajorMatrixX sum = RowMajorMatrixX::Zero(3, at.model.nv);
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, at.model.nv);
  double mass = 0.0;
  for (int b = 1; b < at.model.bodyCount(); ++b) {
    const Body& body = at.model.bodies[idx(b)];
    pointJacobian(at.model, at.k, b, at.k.X_WB[idx(b)] * body.com, J);
    sum += body.mass * J;
    mass += body.mass;
  }
  return sum / mass;
}

py::tuple rows(const MatrixX& x, const MatrixX& y, const MatrixX& z) {
  return py::make_tuple(RowMajorMatrixX(x), RowMajorMatrixX(y), RowMajorMatrixX(z));
}

py::tuple inverseDerivatives(Simulation& sim, const py::object& a, const py::object& q,
                             const py::object& v) {
  const AtState at(sim, q, v);
  const VectorX wished = accelerationOf(sim, a);
  const Input input = computeStagesUnder(sim, {}, true);
  InverseDerivative of(sim.model());
  expectSolved(sim,
               of.compute(sim.model(), input, sim.state(), wished, &sim.contacts(), sim.data()));
  return rows(of.q(), of.v(), of.a().dense());
}

py::tuple forwardDerivatives(Simulation& sim, const py::object& tau, const py::object& q,
                             const py::object& v) {
  const AtState at(sim, q, v);
  const Input input = computeStagesUnder(sim, forceOf(sim, tau), true);
  expectSolved(sim, forwardDynamics(sim.model(), sim.state(), sim.data()));
  ForwardDerivative of(sim.model());
  expectSolved(sim, of.compute(sim.model(), input, sim.state(), &sim.contacts(), sim.data()));
  return rows(of.q(), of.v(), of.tau());
}

py::tuple stepDerivatives(Simulation& sim, const py::object& tau, const py::object& q,
                          const py::object& v) {
  const AtState at(sim, q, v);
  const Input input = inputUnder(sim, forceOf(sim, tau));
  Model bare = sim.model();
  bare.options = StepDerivative::bareStep(bare.options);
  State start(bare);
  start.q = sim.state().q;
  start.v = sim.state().v;
  Data data(bare);
  StepDerivative of(bare);
  if (isRefused(of.compute(bare, input, start, &sim.contacts(), data)))
    throw StepError("step_derivatives: the step from here is not finite");
  return py::make_tuple(RowMajorMatrixX(of.state()), RowMajorMatrixX(of.tau()));
}

template <class F>
auto posed(F f) {
  return [f](Held& held, const py::object& q, const py::object& v) {
    return held.alone([&](Simulation& sim) { return f(Posed(sim, q, v)); });
  };
}

template <class F>
auto configured(F f) {
  return [f](Held& held, const py::object& q) {
    return held.alone([&](Simulation& sim) { return f(Posed(sim, q, py::none())); });
  };
}

/// The derivatives of a simulation that no other thread uses.
auto alone(py::tuple (*derivatives)(Simulation&, const py::object&, const py::object&,
                                    const py::object&)) {
  return [derivatives](Held& held, const py::object& x, const py::object& q, const py::object& v) {
    return held.alone([&](Simulation& sim) { return derivatives(sim, x, q, v); });
  };
}

}  // namespace

void bindQuantities(HeldClass& sim) {
  const auto q = py::arg("q") = py::none(), v = py::arg("v") = py::none();
  sim.def("bias_forces", posed(biasForces), q, v,
          "(nv,) gravity, Coriolis and centripetal forces b of M a + b = τ [N m or N], without\n"
          "contacts. At q and v or at the present ones, as all that follows.");
  sim.def("energy", posed(energy), q, v,
          "(kinetic, potential) [J]: rotors included; zero height is the world's origin.");
  sim.def("momentum", posed(momentum), q, v,
          "(6,) of all moving links, world axes: linear [kg m/s], then angular about the centre\n"
          "of mass [kg m²/s], without rotors.");
  sim.def("center_of_mass",
          configured([](const Posed& at) -> VectorX { return centerOfMass(at.model, at.k); }), q,
          "(3,) of all moving links, world [m].");
  sim.def("center_of_mass_jacobian", configured(centerOfMassJacobian), q,
          "(3, nv): times v the velocity of center_of_mass() [m/s].");
  const auto point = py::arg("point") = py::make_tuple(0.0, 0.0, 0.0);
  sim.def("link_velocity", ofLink("link_velocity", velocityOf), py::arg("link"), point, q, v,
          "(6,) of a point (3,) of the link [m], world axes: its velocity [m/s], then the link's\n"
          "angular velocity [rad/s]. UnknownName.");
  sim.def("link_bias_acceleration", ofLink("link_bias_acceleration", biasAccelerationOf),
          py::arg("link"), point, q, v,
          "(6,) J̇ v: that of the point [m/s²] and the link [rad/s²] where the joints do not\n"
          "accelerate; under an acceleration a it is jacobian() @ a more. UnknownName.");
  sim.def(
      "integrate",
      [](Held& held, const py::object& from, const py::object& by, double seconds) {
        return held.alone([&](Simulation& s) {
          VectorX to = vectorOf(from, "q", s.model().nq, "nq");
          expectConfiguration(s.model(), to);
          integratePosition(s.model(), vectorOf(by, "v", s.model().nv, "nv"), seconds, to);
          return to;
        });
      },
      py::arg("q"), py::arg("v"), py::arg("seconds") = 1.0,
      "(nq,) where q is after so many seconds at v (nv,): quaternions stay unit.");
  sim.def(
      "difference",
      [](Held& held, const py::object& from, const py::object& to) {
        return held.alone([&](Simulation& s) {
          const VectorX q0 = vectorOf(from, "q0", s.model().nq, "nq"),
                        q1 = vectorOf(to, "q1", s.model().nq, "nq");
          expectConfiguration(s.model(), q0);
          expectConfiguration(s.model(), q1);
          return positionDifference(s.model(), q0, q1);
        });
      },
      py::arg("q0"), py::arg("q1"), "(nv,) with integrate(q0, difference(q0, q1)) = q1.");
}

void bindDerivatives(HeldClass& sim) {
  const auto q = py::arg("q") = py::none(), v = py::arg("v") = py::none();
  const auto tau = py::arg("tau") = py::none();
  sim.def(
      "inverse_dynamics_derivatives", alone(inverseDerivatives), py::arg("a"), q, v,
      "(∂τ/∂q, ∂τ/∂v, ∂τ/∂a) of inverse_dynamics(), (nv, nv) each, contacts and limits included;\n"
      "q changes as integrate() has it. At a kink, where a contact begins or slips, those of the\n"
      "side on which its rows are. StepError.");
  sim.def("forward_dynamics_derivatives", alone(forwardDerivatives), tau, q, v,
          "(∂a/∂q, ∂a/∂v, ∂a/∂τ) of forward_dynamics(), (nv, nv) each, likewise. StepError.");
  sim.def(
      "step_derivatives", alone(stepDerivatives), tau, q, v,
      "(A, B): ∂(q, v)/∂(q, v) (2 nv, 2 nv) and ∂(q, v)/∂τ (2 nv, nv) of one step, under a force\n"
      "and without goals, of the leapfrog that is not divided and predicts nothing. StepError.");
}

}  // namespace softgauss::python
