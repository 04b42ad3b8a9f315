// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Some trees of a model, with the world, as a model of their own.
///
/// Bodies, dofs, ranges, equalities, geometries and frames keep their order; what joins a tree that
/// is left out is left out. Names of bodies and visuals are not taken along: the whole model has
/// them. An algorithm that runs on the part does for its trees what it does on the whole, bit for
/// bit, as long as nothing reaches across.

#include <vector>

#include "softgauss/engine/model/state.hpp"

namespace softgauss {

struct SubModel {
  Model model;
  std::vector<int> trees;        ///< (trees of the part) their indices in the whole, ascending
  std::vector<int> geometries;   ///< (geometries of the part) their indices in the whole, ascending
  std::vector<int> frames;       ///< (frames of the part) their indices in the whole, ascending
  std::vector<int> connections;  ///< (connections of the part) likewise

  /// `ofWhole`: trees, ascending.
  SubModel(const Model& whole, std::vector<int> ofWhole);

  /// Entries of q, v and what goes with them, from the whole's state. Of the warm start the vectors
  /// are taken along; the breakpoints of rows, which have other names here, are not.
  void gather(const Model& whole, const State& from, State& to) const;
  /// The same back. The time is not written.
  void scatter(const Model& whole, const State& from, State& to) const;
  /// Dofs of x (nv of the whole), into y (nv of the part).
  void gather(const Model& whole, const VectorX& x, VectorX& y) const;
  void scatter(const Model& whole, const VectorX& y, VectorX& x) const;
  /// Coordinates q (nq of the whole), into those of the part.
  void gatherPosition(const Model& whole, const VectorX& q, VectorX& ofPart) const;
  /// The index here of a body, dof, or frame of the whole; −1: it is not here.
  int bodyOf(const Model& whole, int body) const;
  int dofOf(const Model& whole, int dof) const;
  int frameOf(int frame) const;
};

}  // namespace softgauss
