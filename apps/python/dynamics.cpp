// SPDX-License-Identifier: Apache-2.0
/// Simulation: forward and inverse dynamics, mass matrix, Jacobians.

#include "apps/python/at_state.hpp"
#include "apps/python/held.hpp"
#include "apps/python/stages.hpp"

namespace softgauss::python {
namespace {

VectorX forward(Held& held, const py::object& tau, const py::object& q, const py::object& v) {
  return held.alone([&](Simulation& sim) {
    const AtState at(sim, q, v);
    computeStagesUnder(sim, forceOf(sim, tau), false);
    expectSolved(sim, forwardDynamics(sim.model(), sim.state(), sim.data()));
    return sim.data().forward.a;
  });
}

/// g(a), and P there where it is asked for.
VectorX inverse(Simulation& sim, const py::object& a, const py::object& q, const py::object& v,
                RowMajorMatrixX* P) {
  const AtState at(sim, q, v);
  const VectorX wished = accelerationOf(sim, a);
  computeStagesUnder(sim, {}, P != nullptr);
  VectorX tau;
  inverseDynamics(sim.model(), wished, sim.data(), tau);
  if (P) {
    TreeMatrix curvature;
    inverseDynamicsJacobian(sim.data(), curvature);
    *P = curvature.dense();
  }
  return tau;
}

RowMajorMatrixX massMatrix(Held& held, const py::object& q) {
  return held.alone([&](Simulation& sim) -> RowMajorMatrixX {
    MassMatrix mass(sim.model());
    computeMassMatrix(sim.model(), Posed(sim, q, py::none()).k, mass);
    return mass.M.dense();
  });
}

RowMajorMatrixX jacobian(Held& held, const std::string& link, const py::object& point,
                         const py::object& q) {
  return held.alone([&](Simulation& sim) -> RowMajorMatrixX {
    const Model& model = sim.model();
    const Frame& frame = frameOf(model, link, "jacobian");
    const Posed at(sim, q, py::none());
    Eigen::Matrix<double, 3, Eigen::Dynamic> linear(3, model.nv), angular(3, model.nv);
    pointJacobian(model, at.k, frame.body, at.placeOf(frame, point), linear);
    rotationJacobian(model, at.k, frame.body, angular);
    RowMajorMatrixX J(6, model.nv);
    J << linear, angular;
    return J;
  });
}

}  // namespace

void bindDynamics(HeldClass& sim) {
  const auto q = py::arg("q") = py::none(), v = py::arg("v") = py::none();
  sim.def(
      "forward_dynamics", forward, py::arg("tau") = py::none(), q, v,
      "(nv,) acceleration [rad/s² or m/s²] under the generalised force tau (nv,) [N m or N], or\n"
      "under `tau`, contacts and limits included, without goals. At q and v or at the present\n"
      "ones; the state is left as it is. Raises StepError.");
  sim.def(
      "inverse_dynamics",
      [](Held& h, const py::object& a, const py::object& q_, const py::object& v_) {
        return h.alone([&](Simulation& s) { return inverse(s, a, q_, v_, nullptr); });
      },
      py::arg("a"), q, v,
      "(nv,) generalised force [N m or N] under which the acceleration is a (nv,), contacts and\n"
      "limits included: of forward_dynamics() the inverse, without an iteration. StepError.");
  sim.def(
      "inverse_dynamics_jacobian",
      [](Held& h, const py::object& a, const py::object& q_, const py::object& v_) {
        return h.alone([&](Simulation& s) {
          RowMajorMatrixX P;
          inverse(s, a, q_, v_, &P);
          return P;
        });
      },
      py::arg("a"), q, v,
      "(nv, nv) P = ∂τ/∂a of inverse_dynamics() at a (nv,), symmetric and positive definite.");
  sim.def("mass_matrix", massMatrix, q,
          "(nv, nv) inertia, rotors included [kg m², kg m, kg]. Raises StepError where q is no\n"
          "configuration: NaN, ∞, a quaternion of length 0.");
  sim.def("jacobian", jacobian, py::arg("link"), py::arg("point") = py::make_tuple(0.0, 0.0, 0.0),
          q,
          "(6, nv) of a point (3,) of the link [m], world axes: J @ v is its velocity [m/s], then\n"
          "the link's angular velocity [rad/s]. UnknownName, StepError.");
}

}  // namespace softgauss::python
