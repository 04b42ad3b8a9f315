// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/islands/sub_model.hpp"

#include <algorithm>
#include <utility>

namespace softgauss {
namespace {

/// Entries [from, from + count) of a vector of the whole are [to, to + count) of the part's.
struct Block {
  int from, to, count;
};

Block dofsOf(const Model& whole, const Model& part, int wholeTree, std::size_t partTree) {
  const Tree& from = whole.trees[static_cast<std::size_t>(wholeTree)];
  return {from.firstDof, part.trees[partTree].firstDof, from.dofEnd - from.firstDof};
}

/// The same of q, which starts with the root's.
Block coordinatesOf(const Model& whole, const Model& part, int wholeTree, std::size_t partTree) {
  const auto q = [](const Model& m, int body) {
    return m.bodies[static_cast<std::size_t>(body)].q;
  };
  const Tree& from = whole.trees[static_cast<std::size_t>(wholeTree)];
  const int first = q(whole, from.rootBody);
  const int end = from.bodyEnd < whole.bodyCount() ? q(whole, from.bodyEnd) : whole.nq;
  return {first, q(part, part.trees[partTree].rootBody), end - first};
}

/// What a warm start has of every dof.
constexpr VectorX WarmStart::*kWarmVectors[] = {&WarmStart::a, &WarmStart::gddA,
                                                &WarmStart::multipliers, &WarmStart::control};

/// State::connectionForces of one connection.
auto ofConnection(State& state, int i) { return state.connectionForces.segment<9>(9 * i); }
auto ofConnection(const State& state, int i) { return state.connectionForces.segment<9>(9 * i); }

/// The place of x in ascending numbers, −1: it is not there.
int placeIn(const std::vector<int>& numbers, int x) {
  const auto place = std::lower_bound(numbers.begin(), numbers.end(), x);
  return place != numbers.end() && *place == x ? static_cast<int>(place - numbers.begin()) : -1;
}

/// Makes the part; `newBody`, `newGeometry`: indices in it, −1 for what is left out.
class Extraction {
 public:
  Extraction(const Model& whole, SubModel& part)
      : whole_(whole),
        part_(part),
        newBody_(whole.bodies.size(), -1),
        newGeometry_(whole.geometries.size(), -1) {}

  void run() {
    Model& m = part_.model;
    m.name = whole_.name;
    m.options = whole_.options;
    m.bodies.push_back(whole_.bodies[0]);
    newBody_[0] = 0;
    for (const int tree : part_.trees) addTree(whole_.trees[static_cast<std::size_t>(tree)]);
    m.bodies[0].subtreeEnd = m.bodyCount();
    addFrames();
    m.bodyNames.resize(m.bodies.size());
    m.jointNames.resize(m.bodies.size());
    addJoints();
    addGeometries();
    part_.gatherPosition(whole_, whole_.q0, m.q0);
  }

 private:
  int body(int ofWhole) const { return newBody_[static_cast<std::size_t>(ofWhole)]; }

  void addTree(const Tree& from) {
    Model& m = part_.model;
    const int bodyShift = m.bodyCount() - from.rootBody;
    const int dofShift = m.nv - from.firstDof;
    const int qShift = m.nq - whole_.bodies[static_cast<std::size_t>(from.rootBody)].q;
    Tree tree = from;
    tree.rootBody += bodyShift, tree.bodyEnd += bodyShift;
    tree.firstDof += dofShift, tree.dofEnd += dofShift;
    for (int b = from.rootBody; b < from.bodyEnd; ++b) {
      Body copy = whole_.bodies[static_cast<std::size_t>(b)];
      newBody_[static_cast<std::size_t>(b)] = b + bodyShift;
      copy.parent = body(copy.parent);
      copy.subtreeEnd += bodyShift;
      copy.tree = static_cast<int>(m.trees.size());
      copy.q += qShift, copy.v += dofShift;
      m.nq += copy.joint == JointKind::floating ? 7 : copy.dofs;
      m.bodies.push_back(copy);
    }
    for (int i = from.firstDof; i < from.dofEnd; ++i) {
      Dof dof = whole_.dofs[static_cast<std::size_t>(i)];
      dof.body += bodyShift;
      if (dof.parent >= 0) dof.parent += dofShift;
      m.dofs.push_back(dof);
    }
    m.nv += from.dofEnd - from.firstDof;
    m.trees.push_back(tree);
  }

  /// Ranges and equalities of which every body is here.
  void addJoints() {
    Model& m = part_.model;
    for (JointRange range : whole_.ranges)
      if ((range.body = body(range.body)) >= 0) m.ranges.push_back(range);
    for (std::size_t i = 0; i < whole_.connections.size(); ++i) {
      Connection c = whole_.connections[i];
      if (!move(c.bodyA, c.bodyB)) continue;
      part_.connections.push_back(static_cast<int>(i));
      m.connections.push_back(c);
    }
    for (Weld w : whole_.welds)
      if (move(w.bodyA, w.bodyB)) m.welds.push_back(w);
    for (JointCoupling c : whole_.couplings)
      if (move(c.follower, c.leader)) m.couplings.push_back(c);
  }

  void addGeometries() {
    Model& m = part_.model;
    for (std::size_t g = 0; g < whole_.geometries.size(); ++g) {
      const int b = body(whole_.geometries[g].body);
      if (b < 0) continue;
      newGeometry_[g] = static_cast<int>(m.geometries.size());
      part_.geometries.push_back(static_cast<int>(g));
      m.geometries.push_back(whole_.geometries[g]);
      m.geometries.back().body = b;
    }
    for (ContactPair pair : whole_.contactPairs) {
      pair.geometryA = newGeometry_[static_cast<std::size_t>(pair.geometryA)];
      pair.geometryB = newGeometry_[static_cast<std::size_t>(pair.geometryB)];
      if (pair.geometryA >= 0 && pair.geometryB >= 0) m.contactPairs.push_back(pair);
    }
  }

  void addFrames() {
    for (std::size_t f = 0; f < whole_.frames.size(); ++f) {
      Frame frame = whole_.frames[f];
      if ((frame.body = body(frame.body)) < 0) continue;
      part_.frames.push_back(static_cast<int>(f));
      part_.model.frames.push_back(std::move(frame));
    }
  }

  bool move(int& a, int& b) const {
    a = body(a), b = body(b);
    return a >= 0 && b >= 0 && (a > 0 || b > 0);
  }

  const Model& whole_;
  SubModel& part_;
  std::vector<int> newBody_, newGeometry_;
};

}  // namespace

SubModel::SubModel(const Model& whole, std::vector<int> ofWhole) : trees(std::move(ofWhole)) {
  Extraction(whole, *this).run();
}

int SubModel::bodyOf(const Model& whole, int body) const {
  if (body == 0) return 0;
  const int tree = whole.bodies[static_cast<std::size_t>(body)].tree;
  const int place = placeIn(trees, tree);
  if (place < 0) return -1;
  return body - whole.trees[static_cast<std::size_t>(tree)].rootBody +
         model.trees[static_cast<std::size_t>(place)].rootBody;
}

int SubModel::dofOf(const Model& whole, int dof) const {
  const int ofWhole = whole.dofs[static_cast<std::size_t>(dof)].body;
  const int here = bodyOf(whole, ofWhole);
  if (here < 0) return -1;
  return dof - whole.bodies[static_cast<std::size_t>(ofWhole)].v +
         model.bodies[static_cast<std::size_t>(here)].v;
}

int SubModel::frameOf(int frame) const { return placeIn(frames, frame); }

void SubModel::gatherPosition(const Model& whole, const VectorX& q, VectorX& ofPart) const {
  ofPart.resize(model.nq);
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const Block block = coordinatesOf(whole, model, trees[t], t);
    ofPart.segment(block.to, block.count) = q.segment(block.from, block.count);
  }
}

void SubModel::gather(const Model& whole, const VectorX& x, VectorX& y) const {
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const Block v = dofsOf(whole, model, trees[t], t);
    y.segment(v.to, v.count) = x.segment(v.from, v.count);
  }
}

void SubModel::scatter(const Model& whole, const VectorX& y, VectorX& x) const {
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const Block v = dofsOf(whole, model, trees[t], t);
    x.segment(v.from, v.count) = y.segment(v.to, v.count);
  }
}

void SubModel::gather(const Model& whole, const State& from, State& to) const {
  gatherPosition(whole, from.q, to.q);
  gather(whole, from.v, to.v);
  const WarmStart& ofWhole = from.warmstart;
  to.warmstart.breakpoints.clear();
  to.warmstart.gddSearchAge.assign(trees.size(), 0);
  to.warmstart.gddSearchWait.assign(trees.size(), 1);
  for (const auto warm : kWarmVectors)
    if ((ofWhole.*warm).size() == whole.nv) {
      (to.warmstart.*warm).resize(model.nv);
      gather(whole, ofWhole.*warm, to.warmstart.*warm);
    }
  if (from.a.size() == whole.nv) gather(whole, from.a, to.a);
  to.hasAcceleration = from.hasAcceleration;
  to.connectionForces.setZero(9 * static_cast<Eigen::Index>(connections.size()));
  if (from.connectionForces.size() > 0)
    for (std::size_t i = 0; i < connections.size(); ++i)
      ofConnection(to, static_cast<int>(i)) = ofConnection(from, connections[i]);
  to.warmstart.valid = ofWhole.valid;
  to.warmstart.gddValid = ofWhole.gddValid;
  to.time = from.time;
}

void SubModel::scatter(const Model& whole, const State& from, State& to) const {
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const Block q = coordinatesOf(whole, model, trees[t], t);
    to.q.segment(q.from, q.count) = from.q.segment(q.to, q.count);
  }
  scatter(whole, from.v, to.v);
  if (to.a.size() == whole.nv) {
    scatter(whole, from.a, to.a);
    to.hasAcceleration = to.hasAcceleration || from.hasAcceleration;
  }
  if (to.connectionForces.size() == 0)
    to.connectionForces.setZero(9 * static_cast<Eigen::Index>(whole.connections.size()));
  for (std::size_t i = 0; i < connections.size(); ++i)
    ofConnection(to, connections[i]) = ofConnection(from, static_cast<int>(i));
  for (const auto warm : kWarmVectors)
    if ((from.warmstart.*warm).size() == model.nv && (to.warmstart.*warm).size() == whole.nv)
      scatter(whole, from.warmstart.*warm, to.warmstart.*warm);
}

}  // namespace softgauss
