// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/coupled_mass.hpp"

#include <set>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/regular_mass.hpp"

namespace softgauss {
namespace {

/// v = G w of what may move, followers as their leaders have them at q.
MatrixX motionsOf(const Model& model, const VectorX& q) {
  struct Follows {
    int leader = -1;
    double slope = 0.0;
  };
  std::vector<Follows> follows(model.dofs.size());
  std::vector<bool> isFree(model.dofs.size(), true);
  for (const JointCoupling& c : model.couplings) {
    const int follower = model.bodies[idx(c.follower)].v;
    isFree[idx(follower)] = false;
    if (c.leader != 0)
      follows[idx(follower)] = {model.bodies[idx(c.leader)].v,
                                c.slope(q[model.bodies[idx(c.leader)].q])};
  }
  std::vector<int> column(model.dofs.size(), -1);
  int columns = 0;
  for (int i = 0; i < model.nv; ++i)
    if (isFree[idx(i)]) column[idx(i)] = columns++;
  MatrixX G = MatrixX::Zero(model.nv, columns);
  for (int i = 0; i < model.nv; ++i) {
    double slope = 1.0;
    int up = i;
    while (up >= 0 && !isFree[idx(up)]) {
      slope *= follows[idx(up)].slope;
      up = follows[idx(up)].leader;
    }
    if (up >= 0) G(i, column[idx(up)]) = slope;
  }
  return G;
}

/// Whether A, dense and symmetric, is singular up to rounding.
bool isSingular(const MatrixX& A) {
  const TreeSparsity sparsity = TreeSparsity::dense(static_cast<int>(A.rows()));
  TreeMatrix copy;
  copy.resize(sparsity);
  for (int i = 0; i < copy.size(); ++i)
    for (int j = 0; j <= i; ++j) copy.row(i)[j] = A(i, j);
  TreeFactor factor;
  return singularDof(copy, factor) >= 0;
}

}  // namespace

void regulariseCoupledJoints(Model& model, const VectorX& q) {
  if (model.couplings.empty()) return;
  Kinematics k(model);
  MassMatrix inertia(model);
  computePoses(model, q, k);
  computeMassMatrix(model, k, inertia);
  TreeFactor factor;
  if (singularDof(inertia.M, factor) < 0) return;
  const MatrixX G = motionsOf(model, q);
  if (G.cols() > 0 && isSingular(G.transpose() * inertia.M.dense() * G)) return;

  std::string told;
  std::set<int> steadied;  // trees
  for (int dof; (dof = singularDof(inertia.M, factor)) >= 0;) {
    const int tree = model.bodies[idx(model.dofs[idx(dof)].body)].tree;
    if (!steadied.insert(tree).second) break;
    std::set<int> coupled;
    for (const JointCoupling& c : model.couplings)
      for (const int body : {c.follower, c.leader})
        if (body != 0 && model.bodies[idx(body)].tree == tree) coupled.insert(body);
    for (const int body : coupled) {
      const int i = model.bodies[idx(body)].v;
      model.dofs[idx(i)].armature += kCoupledShare * inertia.M.row(i)[i];
      told += " " + model.jointNames[idx(body)];
    }
    computeMassMatrix(model, k, inertia);
  }
  model.warnings.push_back(
      "these joints are coupled, and without their couplings the mass matrix would be singular at "
      "the start; each has an armature of a hundredth of the inertia that it feels:" +
      told);
}

}  // namespace softgauss
