// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/articulated_factor.hpp"

#include <algorithm>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/six_vectors.hpp"
#include "softgauss/engine/core/vector_clones.hpp"
#include "softgauss/engine/dynamics/body_motion.hpp"

namespace softgauss {
namespace {

using Coupling = EliminationOrder::Coupling;
using Passing = EliminationOrder::Passing;

/// The arrays of the factor that an elimination reads and writes.
struct Elimination {
  double *inertia, *block;
  const Coupling* couplings;  ///< of the body
  int count;
  const int* pairBlocks;

  double* I(int body) const { return inertia + kSixMatrix * body; }
  double* K(int b) const { return block + kSixMatrix * b; }
};

/// U and V of a joint axis S of `body`.
[[gnu::always_inline]] inline void project(const Elimination& e, int body, const double* S,
                                           double* U, double* V) {
  combineRows(S, e.I(body), U);
  for (int c = 0; c < e.count; ++c) combineRows(S, e.K(e.couplings[c].block), V + kSixRow * c);
}

/// Minimises the joint out; `last`: the one next to the parent, to which the inertia passes at
/// once.
[[gnu::always_inline]] inline void eliminate(const Elimination& e, int body, int parent, bool last,
                                             double inversePivot, const double* U,
                                             const double* V) {
  const bool used = !last || parent != 0;  // what is left of the body's own blocks
  if (!last)
    addOuter(-inversePivot, U, U, e.I(body));
  else if (parent != 0)
    addUpdated(e.I(body), -inversePivot, U, e.I(parent));
  const int* pair = e.pairBlocks;
  for (int c = 0; c < e.count; ++c) {
    const double* Vc = V + kSixRow * c;
    if (used) addOuter(-inversePivot, U, Vc, e.K(e.couplings[c].block));
    addOuter(-inversePivot, Vc, Vc, e.I(e.couplings[c].body));
    for (int d = c + 1; d < e.count; ++d)
      addOuter(-inversePivot, Vc, V + kSixRow * d, e.K(*pair++));
  }
}

[[gnu::always_inline]] inline void pass(const Elimination& e, const Passing& p) {
  const double* K = e.K(p.from);
  double* to = p.to == Passing::To::inertia ? e.I(p.target) : e.K(p.target);
  if (p.to != Passing::To::transposedBlock) addMatrix(K, to);
  if (p.to != Passing::To::block) addTransposedMatrix(K, to);
}

/// What all eliminations share.
struct Arrays {
  const Model& model;
  const EliminationOrder& order;
  std::span<const EliminationOrder::Step> steps;
  const Motion* S;
  const double* diagonal;
  double *inertia, *block, *U, *V, *inversePivot;
  const int* firstV;
};

/// −1, or the joint whose pivot is not positive.
SOFTGAUSS_VECTOR_CLONES int eliminateAll(const Arrays& a) {
  for (const EliminationOrder::Step& step : a.steps) {
    const Body& body = a.model.bodies[idx(step.body)];
    const Elimination e{a.inertia, a.block, a.order.couplings(step), step.couplings,
                        a.order.pairBlocks(step)};
    double* V = a.V + a.firstV[step.body];
    for (int i = body.v + body.dofs - 1; i >= body.v; --i, V += kSixRow * step.couplings) {
      const double* S = numbers(a.S[i]);
      double* U = a.U + kSixRow * i;
      const bool last = i == body.v;
      if (a.diagonal[i] == kInfinity) {  // it takes nothing out of what passes
        a.inversePivot[i] = 0.0;
        std::fill_n(U, kSixRow, 0.0);
        std::fill_n(V, kSixRow * step.couplings, 0.0);
        if (last && body.parent != 0) addMatrix(e.I(step.body), e.I(body.parent));
        continue;
      }
      project(e, step.body, S, U, V);
      const double pivot = dotSix(S, U) + a.diagonal[i];
      if (!(pivot > 0.0)) return i;
      a.inversePivot[i] = 1.0 / pivot;
      eliminate(e, step.body, body.parent, last, a.inversePivot[i], U, V);
    }
    for (int p = step.passing; p < step.passingEnd; ++p) pass(e, a.order.passings()[idx(p)]);
  }
  return -1;
}

/// What both sweeps of a solve share.
struct Solve {
  const Model& model;
  const EliminationOrder& order;
  std::span<const EliminationOrder::Step> steps;
  const Motion* S;
  const double *U, *V;
  const int* firstV;
  const double* inversePivot;
  double* u;
  Force* p;
  double* x;
  Motion* A;
};

/// u and p of all bodies, in the order of elimination.
SOFTGAUSS_VECTOR_CLONES void sweepIn(const Solve& a) {
  for (const EliminationOrder::Step& step : a.steps) {
    const Body& body = a.model.bodies[idx(step.body)];
    const int last = body.v + body.dofs - 1;
    Six p = loadSix(numbers(a.p[step.body]));
    for (int i = last; i >= body.v; --i) {
      a.u[i] = (a.x[i] - dotSix(loadSix(numbers(a.S[i])), p)) * a.inversePivot[i];
      addSix(a.u[i], loadSix(a.U + kSixRow * i), p);
    }
    const Coupling* coupling = a.order.couplings(step);
    for (int c = 0; c < step.couplings; ++c) {
      const double* V = a.V + a.firstV[step.body] + kSixRow * c;
      double* other = numbers(a.p[coupling[c].body]);
      Six sum = loadSix(other);
      for (int i = last; i >= body.v; --i, V += kSixRow * step.couplings)
        addSix(a.u[i], loadSix(V), sum);
      storeSix(sum, other);
    }
    if (body.parent == 0) continue;
    Six parent = loadSix(numbers(a.p[body.parent]));
    parent.low += p.low;
    parent.high += p.high;
    storeSix(parent, numbers(a.p[body.parent]));
  }
}

/// x and the motions, the other way.
SOFTGAUSS_VECTOR_CLONES void sweepOut(const Solve& a) {
  for (std::size_t s = a.steps.size(); s-- > 0;) {
    const EliminationOrder::Step& step = a.steps[s];
    const Body& body = a.model.bodies[idx(step.body)];
    const Coupling* coupling = a.order.couplings(step);
    const int row = kSixRow * step.couplings;
    const double* V = a.V + a.firstV[step.body] + row * body.dofs;
    Six moves = loadSix(numbers(a.A[body.parent]));
    for (int i = body.v; i < body.v + body.dofs; ++i) {
      V -= row;
      double sum = dotSix(loadSix(a.U + kSixRow * i), moves);
      for (int c = 0; c < step.couplings; ++c)
        sum += dotSix(loadSix(V + kSixRow * c), loadSix(numbers(a.A[coupling[c].body])));
      a.x[i] = a.u[i] - a.inversePivot[i] * sum;
      addSix(a.x[i], loadSix(numbers(a.S[i])), moves);
    }
    storeSix(moves, numbers(a.A[step.body]));
  }
}

/// A ← A + c Lᵀ H R for rows of eight, at most six.
template <int dim>
[[gnu::always_inline]] inline void addProductOf(double c, const double* L, const double* H,
                                                const double* R, double* A) {
  Row HR[dim];
  for (int d = 0; d < dim; ++d) {
    HR[d] = scaled(c * H[d * dim], loadRow(R));
    for (int e = 1; e < dim; ++e) addRow(c * H[d * dim + e], loadRow(R + kSixRow * e), HR[d]);
  }
  for (int r = 0; r < 6; ++r) {
    Row sum = loadRow(A + kSixRow * r);
    for (int d = 0; d < dim; ++d) addRow(L[kSixRow * d + r], HR[d], sum);
    storeRow(sum, A + kSixRow * r);
  }
}

SOFTGAUSS_VECTOR_CLONES void addProduct(int dim, double c, const double* L, const double* H,
                                        const double* R, double* A) {
  switch (dim) {
    case 1:
      return addProductOf<1>(c, L, H, R, A);
    case 2:
      return addProductOf<2>(c, L, H, R, A);
    case 3:
      return addProductOf<3>(c, L, H, R, A);
    case 4:
      return addProductOf<4>(c, L, H, R, A);
    case 5:
      return addProductOf<5>(c, L, H, R, A);
    case 6:
      return addProductOf<6>(c, L, H, R, A);
  }
}

}  // namespace

ArticulatedFactor::ArticulatedFactor(const Model& model)
    : order_(model),
      diagonal_(idx(model.nv)),
      inertia_(idx(kSixMatrix) * model.bodies.size()),
      U_(idx(kSixRow * model.nv)),
      inversePivot_(idx(model.nv)),
      firstV_(model.bodies.size()),
      u_(idx(model.nv)),
      p_(model.bodies.size()),
      motions_(model.bodies.size()) {
  std::vector<std::pair<int, int>> none;
  order_.find(none);
  steps_.reserve(model.trees.size() + 1);
  bodies_.reserve(model.trees.size() + 1);
}

void ArticulatedFactor::begin(const Model& model, const MassMatrix& inertia, double rowScale) {
  rowScale_ = rowScale;
  const Segment all = allBodies(model);
  steps_.assign(1, order_.part(0).steps);
  beginBodies(model, inertia, {&all, 1});
  beginBlocks(model, order_.part(0).blocks);
}

void ArticulatedFactor::begin(const Model& model, const MassMatrix& inertia, Segments bodies) {
  SOFTGAUSS_ASSERT(order_.blocks() == 0);
  rowScale_ = 1.0;
  steps_.clear();
  for (const Segment s : bodies)  // leaves first, which is the last body first
    steps_.push_back({model.bodyCount() - s.end, model.bodyCount() - s.begin});
  beginBodies(model, inertia, bodies);
}

void ArticulatedFactor::begin(const Model& model, const MassMatrix& inertia,
                              const TreeIslands& islands, int island, double rowScale) {
  rowScale_ = rowScale;
  steps_.assign(1, order_.part(island).steps);
  beginBodies(model, inertia, islands.bodies(island));
  beginBlocks(model, order_.part(island).blocks);
}

void ArticulatedFactor::beginBodies(const Model& model, const MassMatrix& inertia,
                                    Segments bodies) {
  bodies_.assign(bodies.begin(), bodies.end());
  pairs_.clear();
  const bool armature = model.options.effects.has(Effect::armature);
  for (const Segment s : bodies_)
    for (int b = s.begin; b < s.end; ++b) {
      const Body& body = model.bodies[idx(b)];
      double* I = inertia_.data() + kSixMatrix * b;
      if (body.massless)
        std::fill_n(I, kSixMatrix, 0.0);
      else
        setInertia(inertia.body[idx(b)], I);
      for (int i = body.v; i < body.v + body.dofs; ++i)
        diagonal_[idx(i)] = (armature ? model.dofs[idx(i)].armature : 0.0) + inertia.added[i];
    }
}

void ArticulatedFactor::beginBlocks(const Model& model, Segment blocks) {
  if (order_.blocks() == 0) return;
  block_.resize(idx(kSixMatrix * order_.blocks()));
  std::fill(block_.begin() + kSixMatrix * blocks.begin, block_.begin() + kSixMatrix * blocks.end,
            0.0);
  int numbers = 0;
  for (const EliminationOrder::Step& step : order_.steps(steps_.front())) {
    firstV_[idx(step.body)] = numbers;
    numbers += kSixRow * step.couplings * model.bodies[idx(step.body)].dofs;
  }
  if (V_.size() < idx(numbers)) V_.resize(idx(numbers));
}

void ArticulatedFactor::addRows(const BodyPair& pair, const double* H) {
  const auto inertiaOf = [&](int body) { return inertia_.data() + kSixMatrix * body; };
  const auto add = [&](const double* L, const double* R, double* A) {
    addProduct(pair.dim, rowScale_, L, H, R, A);
  };
  if (pair.bodyA != 0) add(pair.WA, pair.WA, inertiaOf(pair.bodyA));
  if (pair.bodyB != 0) add(pair.WB, pair.WB, inertiaOf(pair.bodyB));
  if (pair.bodyA == 0 || pair.bodyB == 0) return;
  if (order_.isBefore(pair.bodyA, pair.bodyB))
    add(pair.WA, pair.WB, block_.data() + kSixMatrix * order_.block(pair.bodyA, pair.bodyB));
  else
    add(pair.WB, pair.WA, block_.data() + kSixMatrix * order_.block(pair.bodyB, pair.bodyA));
}

bool ArticulatedFactor::factor(const Model& model, const Kinematics& k) {
  failedJoint_ = -1;
  for (const Segment steps : steps_) {
    const Arrays arrays{
        model,           order_,        order_.steps(steps), k.S.data(), diagonal_.data(),
        inertia_.data(), block_.data(), U_.data(),           V_.data(),  inversePivot_.data(),
        firstV_.data()};
    failedJoint_ = eliminateAll(arrays);
    if (failedJoint_ >= 0) return false;
  }
  return pairs_.empty() || factorPairs(model, k);
}

bool ArticulatedFactor::factorPairs(const Model& model, const Kinematics& k) {
  const auto count = static_cast<Eigen::Index>(pairs_.size());
  X_.resize(model.nv, count);
  S_.resize(count, count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const PairRow& pair = pairs_[static_cast<std::size_t>(c)];
    x_.setZero(model.nv);
    x_[pair.first] = 1.0;
    x_[pair.second] -= pair.slope;
    solveTree(model, k, x_, motions_);
    X_.col(c) = x_;
    for (Eigen::Index r = 0; r < count; ++r) S_(r, c) = pairs_[static_cast<std::size_t>(r)].of(x_);
    S_(c, c) += pair.inverseCurvature;
  }
  pairFactor_.compute(S_);
  if (pairFactor_.info() == Eigen::Success) return true;
  failedJoint_ = pairs_.front().first;
  return false;
}

void ArticulatedFactor::solve(const Model& model, const Kinematics& k, VectorX& x,
                              std::vector<Motion>& A) {
  solveTree(model, k, x, A);
  if (pairs_.empty()) return;
  y_.resize(static_cast<Eigen::Index>(pairs_.size()));
  for (std::size_t r = 0; r < pairs_.size(); ++r)
    y_[static_cast<Eigen::Index>(r)] = pairs_[r].of(x);
  pairFactor_.solveInPlace(y_);
  x.noalias() -= X_ * y_;
  moveBodies(model, k, bodies_, x, A);
}

void ArticulatedFactor::solveTree(const Model& model, const Kinematics& k, VectorX& x,
                                  std::vector<Motion>& A) {
  for (const Segment s : bodies_) std::fill(p_.begin() + s.begin, p_.begin() + s.end, Force{});
  for (const Segment steps : steps_) {
    const Solve arrays{model,     order_,         order_.steps(steps),  k.S.data(), U_.data(),
                       V_.data(), firstV_.data(), inversePivot_.data(), u_.data(),  p_.data(),
                       x.data(),  A.data()};
    sweepIn(arrays);
    sweepOut(arrays);
  }
}

}  // namespace softgauss
